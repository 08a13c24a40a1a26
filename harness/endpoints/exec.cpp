#include "harness/endpoints/exec.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "harness/endpoints/kinds.hpp"
#include "harness/endpoints/options.hpp"
#include "harness/endpoints/set_up/command_marks.hpp"
#include "harness/protocol.hpp"
#include "harness/system/child_process.hpp"
#include "harness/system/fd_link.hpp"
#include "harness/system/line_pipe.hpp"
#include "harness/system/pty_pair.hpp"
#include "src/line/settings.hpp"

namespace fieldproof::endpoints {

namespace {

constexpr std::string_view tty_mark = "{tty}", port_mark = "{port}";

bool uses(const EndpointName& name, std::string_view mark) {
  return name.target.find(mark) != std::string::npos;
}

class ExecEndpoint final : public Endpoint {
 public:
  ExecEndpoint(const EndpointName& name, os::PtyPair pty, Duration floor)
      : command_(name.target),
        config_(config_of(name)),
        slave_(std::move(pty.slave)),
        path_(pty.path),
        link_(std::move(pty.master), describe()) {
    capabilities_ = capabilities_of(name);
    capabilities_.timing_floor = floor;
  }

  const Capabilities& capabilities() const override { return capabilities_; }
  std::string describe() const override { return "exec:" + command_.text(); }
  Time now() const override { return link_.now(); }
  /// A pty has no wire; pauses in characters are meant at the default speed.
  Duration character_time() const override { return line::LineSettings{}.character_time(); }
  Status begin(const nlohmann::json& config) override {
    config_ = config;
    return child_ && command_.filled(config) == running_ ? ok() : start();
  }
  bool configures(std::string_view key) const override { return command_.takes(key); }
  unsigned starts() const override { return starts_; }
  Bytes last_sent() const override { return last_sent_; }
  std::string started_with(const nlohmann::json& config) const override {
    return command_.filled(config);
  }
  using Endpoint::send;
  Result<Sent> send(ByteView bytes, LinkId) override {
    if (const Status started = be_started(); !started) return started.error();
    Result<Sent> sent = link_.send(bytes);
    if (sent) last_sent_.assign(bytes.begin(), bytes.end());
    return sent;
  }
  Result<Burst> receive(Time deadline) override {
    if (const Status started = be_started(); !started) return started.error();
    return link_.receive(deadline);
  }

  Status tell(std::string_view line) override {
    if (is_stdio())
      return fail(
          fmt::format("cannot tell {} what to request: its standard input is the port; write "
                      "{{tty}} where the command takes its path",
                      describe()));
    if (const Status started = be_started(); !started) return started;
    if (os::write_line(input_.get(), std::string(line))) return ok();
    return fail(fmt::format("cannot tell {} what to request: {}", describe(), child_->how()));
  }

  std::string answer(Duration patience) override {
    return child_ ? child_->answer(patience) : std::string();
  }

  Status act(std::string_view action) override {
    if (action == "power_cycle") return start();
    return fail(
        fmt::format("cannot do '{}' on {}: the bench can only power_cycle it", action, describe()));
  }

 private:
  bool is_stdio() const { return command_.text().find(tty_mark) == std::string::npos; }

  /// By whoever asks it first, where no case has said what it is to be.
  Status be_started() { return child_ ? ok() : start(); }

  Status start() {
    running_ = command_.filled(config_);
    ++starts_;
    last_sent_.clear();
    link_.set_far_end(nullptr);
    child_.reset();
    os::drop_waiting_bytes(link_.fd());
    os::drop_waiting_bytes(slave_.get());
    os::set_raw(slave_.get());
    os::ChildOptions options;
    options.arguments = os::shell(with_mark(running_, tty_mark, path_));
    options.terminal = slave_.get();
    options.terminal_is_stdio = is_stdio();
    Result<os::LinePipe> pipe = os::open_line_pipe();
    if (!pipe) return pipe.error();
    options.standard_input = pipe->child.get();
    input_ = std::move(pipe->bench);
    Result<std::unique_ptr<os::ChildProcess>> child = os::ChildProcess::start(options);
    if (!child) return child.error();
    child_ = std::move(*child);
    link_.set_far_end(child_.get());
    return ok();
  }

  Capabilities capabilities_;
  CommandMarks command_;
  nlohmann::json config_;  // of the present case
  std::string running_;    // the command, filled
  unsigned starts_ = 0;
  Bytes last_sent_;
  os::UniqueFd slave_;  // kept open: no close of the device under test ends the line
  std::string path_;
  os::FdLink link_;
  os::UniqueFd input_;  // the child's standard input
  std::unique_ptr<os::ChildProcess> child_;
};

}  // namespace

Status check_command(const EndpointName& name) {
  if (uses(name, port_mark) && uses(name, tty_mark))
    return fail("{port} and {tty} exclude each other: the device is on a network or on a line");
  return CommandMarks::check(name.target);
}

Status check_command_for(const EndpointName& name, const harness::Protocol& protocol) {
  const bool network = protocol.on_network();
  if (network && !uses(name, port_mark))
    return fail("it runs on a network; write {port} where the command takes the port");
  if (!network && uses(name, port_mark))
    return fail("it runs on a serial line; write {tty} where the command takes its path");
  return ok();
}

nlohmann::json config_of(const EndpointName& name) {
  return {{"station", name.option("station", "1")}, {"protocol", name.option("protocol", "")}};
}

std::string with_mark(std::string command, std::string_view mark, const std::string& value) {
  for (std::size_t at = 0; (at = command.find(mark, at)) != std::string::npos; at += value.size())
    command.replace(at, mark.size(), value);
  return command;
}

Result<std::unique_ptr<Endpoint>> open_exec(const EndpointName& name,
                                            const harness::Protocol& protocol) {
  if (name.target.empty()) {
    return fail(
        "cannot open exec: there is no command; write exec:COMMAND, with {tty} for the path of its "
        "port");
  }
  if (uses(name, port_mark)) return open_exec_network(name, protocol);
  const Result<Duration> floor = timing_floor(name);
  if (!floor) return floor.error();
  Result<os::PtyPair> pty = os::open_pty_pair();
  if (!pty) return pty.error();
  return std::unique_ptr<Endpoint>(std::make_unique<ExecEndpoint>(name, std::move(*pty), *floor));
}

}  // namespace fieldproof::endpoints
