#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>

#include <array>
#include <nlohmann/json.hpp>

#include "harness/endpoints/exec.hpp"
#include "harness/endpoints/kinds.hpp"
#include "harness/endpoints/network.hpp"
#include "harness/endpoints/network_name.hpp"
#include "harness/endpoints/options.hpp"
#include "harness/endpoints/set_up/command_marks.hpp"
#include "harness/protocol.hpp"
#include "harness/system/child_process.hpp"
#include "harness/system/interrupt.hpp"
#include "harness/system/line_pipe.hpp"
#include "harness/system/pty_pair.hpp"
#include "harness/system/sockets/socket_connect.hpp"
#include "harness/system/sockets/socket_listen.hpp"

namespace fieldproof::endpoints {

namespace {

constexpr const char* loopback = "127.0.0.1";
constexpr std::string_view udp_mark = "{udp_port}";
constexpr Duration start_limit = 10s;
constexpr int again_ms = 10;  // after a connection was refused

class ExecNetworkEndpoint final : public NetworkEndpoint {
 public:
  ExecNetworkEndpoint(const EndpointName& name, const Capabilities& capabilities,
                      os::RemoteHost host, os::PtyPair pty, NetworkPorts defaults)
      : NetworkEndpoint("exec:" + name.target, capabilities),
        command_(name.target),
        config_(config_of(name)),
        host_(std::move(host)),
        pty_(std::move(pty)),
        defaults_(std::move(defaults)) {}
  ~ExecNetworkEndpoint() override { sockets().set_far_end(nullptr); }

  /// Only the role counts: a client finds the bench listening.
  Status begin(const nlohmann::json& config) override {
    const bool client = config.value("role", "server") == "client";
    config_ = config;
    if (!child_ || client != client_ || command_.filled(config) != running_) return start(client);
    if (!client) return NetworkEndpoint::begin(config);
    sockets().end_closed();  // it may keep a connection over several cases, but not one of these
    return ok();
  }

  bool configures(std::string_view key) const override { return command_.takes(key); }
  unsigned starts() const override { return starts_; }
  Bytes last_sent() const override { return last_sent_; }
  std::string started_with(const nlohmann::json& config) const override {
    return command_.filled(config) + (config.value("role", "server") == "client" ? " client" : "");
  }

  Result<LinkId> open(Transport transport, std::uint16_t port) override {
    if (!child_)
      if (const Status started = start(false); !started) return started.error();
    if (client_) return cannot_open(transport, "this case is of a client, which opens the links");
    const std::uint16_t own = transport == Transport::tcp ? tcp_ : udp_;
    if (own == 0)
      return cannot_open(transport, "write {udp_port} where the command takes its port");
    if (port == 0 || port == defaults_.of(transport)) port = own;
    Result<os::UniqueFd> fd = transport == Transport::udp ? host_.connect(port, SOCK_DGRAM)
                              : ready_                    ? host_.connect(port, SOCK_STREAM)
                                                          : connect_when_ready(port);
    if (!fd) return fd.error();
    refused_ = !*fd && host_.nobody_listens();
    return sockets().add(transport, std::move(*fd), port);
  }
  bool was_refused() const override { return refused_; }

  using Endpoint::send;
  Result<Sent> send(ByteView bytes, LinkId link) override {
    const bool ran = child_ && !child_->ended();
    Result<Sent> sent = NetworkEndpoint::send(bytes, link);
    if (sent && ran) last_sent_.assign(bytes.begin(), bytes.end());
    return sent;
  }
  void lose_links() override { sockets().lose_all(); }

  Status tell(std::string_view line) override {
    if (os::write_line(input_.get(), std::string(line))) return ok();
    return fail(fmt::format("cannot tell {} what to request: {}", describe(), child_->how()));
  }

  std::string answer(Duration patience) override {
    return child_ ? child_->answer(patience) : std::string();
  }

  Status act(std::string_view action) override {
    if (action == "power_cycle") return start(client_);
    return fail(
        fmt::format("cannot do '{}' on {}: the bench can only power_cycle it", action, describe()));
  }

 private:
  Status start(bool client) {
    running_ = command_.filled(config_);
    ++starts_;
    last_sent_.clear();
    sockets().set_far_end(nullptr);
    child_.reset();
    sockets().lose_all();
    ready_ = false;
    client_ = client;
    if (const Status chosen = choose_port(Transport::tcp, tcp_); !chosen) return chosen;
    if (const Status chosen = choose_port(Transport::udp, udp_); !chosen) return chosen;
    Result<os::LinePipe> pipe = os::open_line_pipe();
    if (!pipe) return pipe.error();
    os::ChildOptions options;
    options.arguments = os::shell(with_mark(with_mark(running_, udp_mark, std::to_string(udp_)),
                                            "{port}", std::to_string(tcp_)));
    options.terminal = pty_.slave.get();  // its hangup ends the child with the bench
    options.standard_input = pipe->child.get();
    input_ = std::move(pipe->bench);
    Result<std::unique_ptr<os::ChildProcess>> child = os::ChildProcess::start(options);
    if (!child) return child.error();
    child_ = std::move(*child);
    sockets().set_far_end(child_.get());
    return ok();
  }

  /// A port that is free now. The bench keeps the one that a client is to connect to.
  Status choose_port(Transport transport, std::uint16_t& port) {
    if (transport == Transport::udp && command_.text().find(udp_mark) == std::string::npos)
      return ok();
    Result<os::UniqueFd> fd =
        os::listen_socket({loopback, 0}, transport == Transport::tcp ? SOCK_STREAM : SOCK_DGRAM);
    if (!fd) return fd.error();
    port = os::local_address(fd->get()).port();
    if (client_) sockets().listen(std::move(*fd), transport, port);
    return ok();
  }

  Result<os::UniqueFd> connect_when_ready(std::uint16_t port) {
    for (const Time give_up = now() + start_limit;;) {
      Result<os::UniqueFd> fd = host_.connect(port, SOCK_STREAM);
      if (!fd) return fd;
      ready_ = static_cast<bool>(*fd);
      if (ready_) return fd;
      if (child_->ended()) return cannot_open(Transport::tcp, child_->how());
      if (now() >= give_up)
        return cannot_open(
            Transport::tcp,
            fmt::format("nothing listened on {}:{} within 10 s; see that the command "
                        "listens on {{port}}; {}",
                        loopback, port, child_->how()));
      std::array<pollfd, 2> fds{pollfd{child_->end_fd(), POLLIN, 0},
                                pollfd{os::interrupt_fd(), POLLIN, 0}};
      ::poll(fds.data(), fds.size(), again_ms);
      if (os::interrupted()) return os::interrupted_error("connect to", describe());
    }
  }

  CommandMarks command_;
  nlohmann::json config_;  // of the present case
  std::string running_;    // the command, filled
  unsigned starts_ = 0;
  Bytes last_sent_;
  os::RemoteHost host_;
  bool refused_ = false;  // the last one
  os::PtyPair pty_;
  NetworkPorts defaults_;
  std::uint16_t tcp_ = 0, udp_ = 0;
  bool client_ = false;
  bool ready_ = false;  // has accepted a connection since its start
  os::UniqueFd input_;  // the child's standard input
  std::unique_ptr<os::ChildProcess> child_;
};

}  // namespace

Result<std::unique_ptr<Endpoint>> open_exec_network(const EndpointName& name,
                                                    const harness::Protocol& protocol) {
  const Result<Duration> floor = timing_floor(name);
  if (!floor) return floor.error();
  Result<os::RemoteHost> host = os::RemoteHost::find(loopback);
  if (!host) return host.error();
  Result<os::PtyPair> pty = os::open_pty_pair();
  if (!pty) return pty.error();
  Capabilities can = capabilities_of(name);
  can.connections = true;
  can.datagrams = name.target.find(udp_mark) != std::string::npos;
  can.timing_floor = *floor;
  return std::unique_ptr<Endpoint>(std::make_unique<ExecNetworkEndpoint>(
      name, can, std::move(*host), std::move(*pty), default_ports(protocol)));
}

}  // namespace fieldproof::endpoints
