#include "harness/endpoints/pty.hpp"

#include <sys/socket.h>

#include <cerrno>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "harness/endpoints/kinds.hpp"
#include "harness/endpoints/options.hpp"
#include "harness/endpoints/set_up/device_control.hpp"
#include "harness/system/child_process.hpp"
#include "harness/system/fd_link.hpp"
#include "harness/system/pty_pair.hpp"
#include "harness/system/system_calls.hpp"
#include "src/line/settings.hpp"

namespace fieldproof::endpoints {

namespace {

using nlohmann::json;

constexpr Duration answer_limit = 5s;

std::string executable() {
  const char* other = std::getenv("FIELDPROOF_EXECUTABLE");
  return other && *other ? other : "/proc/self/exe";
}

/// "xbc-h?station=1": the options but those that are the endpoint's own.
std::string device_name(const EndpointName& name) {
  std::string text = name.target;
  char mark = '?';
  for (const auto& [key, value] : name.options) {
    if (key == "floor_ms" || key == "echo") continue;
    text += mark + key + '=' + value;
    mark = '&';
  }
  return text;
}

class PtyEndpoint final : public Endpoint {
 public:
  PtyEndpoint(const EndpointName& name, os::PtyPair pty, os::UniqueFd control,
              std::unique_ptr<os::ChildProcess> child, Duration floor)
      : name_(name),
        child_(std::move(child)),
        slave_(std::move(pty.slave)),
        link_(std::move(pty.master), "pty:" + name.target),
        control_(std::move(control), "the emulator behind pty:" + name.target) {
    capabilities_ = capabilities_of(name);
    capabilities_.timing_floor = floor;
    link_.set_far_end(child_.get());
    control_.set_far_end(child_.get());
  }

  const Capabilities& capabilities() const override { return capabilities_; }
  std::string describe() const override {
    return "pty: emulator" + (name_.target.empty() ? "" : ' ' + name_.target);
  }
  Time now() const override { return link_.now(); }
  /// A pty has no wire; pauses in characters are meant at the device's speed.
  Duration character_time() const override { return line_.character_time(); }

  Status begin(const json& config) override {
    const Result<line::LineSettings> line = line::parse_line_settings(line_of(config));
    if (!line) return line.error();
    line_ = *line;
    // Bytes on their way to the old device, and after the answer those that it had sent: neither
    // concerns this case.
    os::drop_waiting_bytes(link_.fd());
    const Result<json> begun = ask({{"begin", config}});
    os::drop_waiting_bytes(link_.fd());
    return status_of(begun);
  }

  using Endpoint::send;
  Result<Sent> send(ByteView bytes, LinkId) override { return link_.send(bytes); }
  Result<Burst> receive(Time deadline) override { return link_.receive(deadline); }

  Status set(std::string_view address, std::string_view hex) override {
    return status_of(ask({{"set", {{std::string(address), hex}}}}));
  }
  Result<std::string> get(std::string_view address, std::size_t digits) override {
    const Result<json> values = ask({{"get", {{std::string(address), digits}}}});
    if (!values) return values.error();
    return values->value(std::string(address), "");
  }
  Status act(std::string_view action) override { return status_of(ask({{"do", action}})); }

 private:
  static Status status_of(const Result<json>& answer) {
    if (answer) return ok();
    return answer.error();
  }

  std::string line_of(const json& config) const {
    const auto found = config.find("line");
    if (found != config.end() && found->is_string()) return found->get<std::string>();
    return name_.option("line", line::to_string(line::LineSettings{}));
  }

  Result<json> ask(const json& request) {
    const std::string question = control_line(request);
    if (const Result<Sent> sent = control_.send(to_bytes(question)); !sent) return sent.error();
    const Time deadline = control_.now() + answer_limit;
    std::string answer;
    while (answer.empty() || answer.back() != '\n') {
      const Result<Burst> burst = control_.receive(deadline);
      if (!burst) return burst.error();
      if (burst->bytes.empty())
        return fail("cannot talk to " + describe() + ": no answer within 5 s; " + child_->how());
      answer += to_text(burst->bytes);
    }
    return read_control_answer(answer);
  }

  Capabilities capabilities_;
  EndpointName name_;
  line::LineSettings line_;
  std::unique_ptr<os::ChildProcess> child_;
  os::UniqueFd slave_;  // kept open: the line does not end while the emulator starts
  os::FdLink link_;
  os::FdLink control_;
};

}  // namespace

Result<std::unique_ptr<Endpoint>> open_pty(const EndpointName& name) {
  const Result<Duration> floor = timing_floor(name);
  if (!floor) return floor.error();
  Result<os::PtyPair> pty = os::open_pty_pair();
  if (!pty) return pty.error();
  int ends[2];
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0)
    return fail("cannot open pty: " + os::errno_text(errno));
  os::UniqueFd ours(ends[0]);
  const os::UniqueFd theirs(ends[1]);
  os::ChildOptions options;
  options.arguments = {
      executable(), "emulate", device_name(name), "--control", std::to_string(theirs.get()),
      "--tty",      pty->path};
  options.keep = {theirs.get()};
  Result<std::unique_ptr<os::ChildProcess>> child = os::ChildProcess::start(options);
  if (!child) return child.error();
  auto endpoint = std::make_unique<PtyEndpoint>(name, std::move(*pty), std::move(ours),
                                                std::move(*child), *floor);
  // Its first answer says that it is ready, and that it accepts the options.
  if (const Status ready = endpoint->begin(json::object()); !ready) {
    return Error{"cannot open pty:" + name.target + ": " + ready.error().message,
                 ready.error().interrupted};
  }
  return std::unique_ptr<Endpoint>(std::move(endpoint));
}

}  // namespace fieldproof::endpoints
