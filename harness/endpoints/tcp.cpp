#include "harness/endpoints/tcp.hpp"

#include <fmt/format.h>
#include <sys/socket.h>

#include <nlohmann/json.hpp>
#include <optional>

#include "harness/endpoints/kinds.hpp"
#include "harness/endpoints/network.hpp"
#include "harness/endpoints/network_name.hpp"
#include "harness/endpoints/options.hpp"
#include "harness/system/fd_link.hpp"
#include "harness/system/sockets/socket_connect.hpp"
#include "src/line/settings.hpp"

namespace fieldproof::endpoints {

namespace {

/// One line over a socket.
class SocketLine final : public Endpoint {
 public:
  /// `type`: SOCK_STREAM or SOCK_DGRAM.
  SocketLine(const EndpointName& name, int type, Duration floor)
      : name_(name.kind + ':' + name.target), where_(name.target), type_(type) {
    capabilities_ = capabilities_of(name);
    capabilities_.timing_floor = floor;
    capabilities_.shared = type == SOCK_STREAM && is_shared(name);
  }

  Status open() {
    Result<os::UniqueFd> fd = os::connect_socket(where_, type_);
    if (!fd) return fd.error();
    link_.emplace(std::move(*fd), name_, clock_);
    if (capabilities_.shared) capabilities_.round_trip = os::round_trip(link_->fd());
    return ok();
  }

  const Capabilities& capabilities() const override { return capabilities_; }
  std::string describe() const override { return name_; }
  Time now() const override { return clock_.now(); }
  /// A socket has no wire; pauses in characters are meant at the default speed.
  Duration character_time() const override { return line::LineSettings{}.character_time(); }
  Status begin(const nlohmann::json&) override {
    if (!link_->dead()) return ok();
    ++reconnections_;
    return open();
  }
  using Endpoint::send;
  Result<Sent> send(ByteView bytes, LinkId) override { return link_->send(bytes); }
  Result<Burst> receive(Time deadline) override { return link_->receive(deadline); }

  bool lets_others_in() override { return os::takes_another_client(where_); }

  std::string line_errors() override {
    const int count = std::exchange(reconnections_, 0);
    return count == 0 ? "" : fmt::format("{} lost connection{}", count, count == 1 ? "" : "s");
  }

 private:
  Capabilities capabilities_;
  std::string name_;
  std::string where_;
  int type_;
  os::RunClock clock_;
  std::optional<os::FdLink> link_;
  int reconnections_ = 0;
};

Result<std::unique_ptr<Endpoint>> open_line(const EndpointName& name, int type) {
  const Result<Duration> floor = timing_floor(name);
  if (!floor) return floor.error();
  auto endpoint = std::make_unique<SocketLine>(name, type, *floor);
  if (const Status opened = endpoint->open(); !opened) return opened.error();
  return std::unique_ptr<Endpoint>(std::move(endpoint));
}

}  // namespace

Result<std::unique_ptr<Endpoint>> open_tcp(const EndpointName& name,
                                           const harness::Protocol& protocol) {
  return protocol.on_network() ? open_network(name, protocol) : open_line(name, SOCK_STREAM);
}
Result<std::unique_ptr<Endpoint>> open_udp(const EndpointName& name,
                                           const harness::Protocol& protocol) {
  return protocol.on_network() ? open_network(name, protocol) : open_line(name, SOCK_DGRAM);
}

}  // namespace fieldproof::endpoints
