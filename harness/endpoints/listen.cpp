#include "harness/endpoints/listen.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "harness/endpoints/kinds.hpp"
#include "harness/endpoints/network.hpp"
#include "harness/endpoints/network_name.hpp"
#include "harness/endpoints/options.hpp"
#include "harness/protocol.hpp"
#include "harness/system/sockets/socket_listen.hpp"

namespace fieldproof::endpoints {

namespace {

class ListenEndpoint final : public NetworkEndpoint {
 public:
  ListenEndpoint(std::string name, const Capabilities& capabilities)
      : NetworkEndpoint(std::move(name), capabilities) {}

  /// `port` 0: any that is free.
  Status listen(const std::string& host, Transport transport, std::uint16_t port) {
    Result<os::UniqueFd> fd =
        os::listen_socket({host, port}, transport == Transport::tcp ? SOCK_STREAM : SOCK_DGRAM);
    if (!fd) return fd.error();
    const std::uint16_t bound = os::local_address(fd->get()).port();
    where_ += fmt::format("{}{} {}", where_.empty() ? "" : ", ",
                          transport == Transport::tcp ? "TCP" : "UDP", bound);
    sockets().listen(std::move(*fd), transport, bound);
    return ok();
  }

  std::string describe() const override {
    return NetworkEndpoint::describe() + " (" + where_ + ')';
  }
  /// The device may keep a connection over several cases, but not one that the bench has closed.
  Status begin(const nlohmann::json&) override {
    sockets().end_closed();
    return ok();
  }
  Result<LinkId> open(Transport transport, std::uint16_t) override {
    return cannot_open(transport,
                       "there the device opens the links; write tcp:HOST:PORT for a server");
  }

 private:
  std::string where_;
};

}  // namespace

Result<std::unique_ptr<Endpoint>> open_listen(const EndpointName& name,
                                              const harness::Protocol& protocol) {
  const Result<Duration> floor = timing_floor(name);
  if (!floor) return floor.error();
  Capabilities can = capabilities_of(name);
  const NetworkPorts ports = network_ports(name, protocol);
  can.connections = true;
  can.datagrams = ports.udp != 0;
  can.timing_floor = *floor;
  auto endpoint = std::make_unique<ListenEndpoint>(name.kind + ':' + name.target, can);
  if (const Status tcp = endpoint->listen(ports.host, Transport::tcp, ports.tcp); !tcp)
    return tcp.error();
  if (ports.udp != 0)
    if (const Status udp = endpoint->listen(ports.host, Transport::udp, ports.udp); !udp)
      return udp.error();
  return std::unique_ptr<Endpoint>(std::move(endpoint));
}

}  // namespace fieldproof::endpoints
