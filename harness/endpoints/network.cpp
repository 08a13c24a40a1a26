#include "harness/endpoints/network.hpp"

#include <fmt/format.h>
#include <sys/socket.h>

#include <nlohmann/json.hpp>

#include "harness/endpoints/kinds.hpp"
#include "harness/endpoints/network_name.hpp"
#include "harness/endpoints/options.hpp"
#include "harness/protocol.hpp"
#include "harness/system/sockets/socket_connect.hpp"

namespace fieldproof::endpoints {

namespace {

class SocketEndpoint final : public NetworkEndpoint {
 public:
  SocketEndpoint(std::string name, const Capabilities& capabilities, os::RemoteHost host,
                 NetworkPorts ports, NetworkPorts defaults)
      : NetworkEndpoint(std::move(name), capabilities),
        host_(std::move(host)),
        ports_(std::move(ports)),
        defaults_(std::move(defaults)) {}

  Result<LinkId> open(Transport transport, std::uint16_t port) override {
    const std::uint16_t own = ports_.of(transport);
    if (own == 0)
      return cannot_open(transport, transport == Transport::udp
                                        ? "the endpoint names no port for datagrams; add ?udp=PORT"
                                        : "the endpoint is for datagrams; write tcp:HOST:PORT");
    if (port == 0 || port == defaults_.of(transport)) port = own;
    Result<os::UniqueFd> fd =
        host_.connect(port, transport == Transport::tcp ? SOCK_STREAM : SOCK_DGRAM);
    if (!fd) return fd.error();
    refused_ = !*fd && host_.nobody_listens();
    return sockets().add(transport, std::move(*fd), port);
  }
  bool was_refused() const override { return refused_; }

 private:
  os::RemoteHost host_;
  NetworkPorts ports_, defaults_;
  bool refused_ = false;  // the last one
};

/// "tcp:plc:2004, UDP 2005"
std::string description(const EndpointName& name, const NetworkPorts& ports) {
  const std::uint16_t port = ports.tcp ? ports.tcp : ports.udp;
  std::string text = name.kind + ':' + to_string(os::SocketName{ports.host, port});
  return ports.tcp && ports.udp ? fmt::format("{}, UDP {}", text, ports.udp) : text;
}

}  // namespace

Status NetworkEndpoint::begin(const nlohmann::json&) {
  sockets_.end_all();
  return ok();
}

Error NetworkEndpoint::cannot_open(Transport transport, const std::string& why) const {
  return fail(fmt::format("cannot open a {} of {}: {}",
                          transport == Transport::tcp ? "connection" : "datagram port", name_,
                          why));
}

Result<std::unique_ptr<Endpoint>> open_network(const EndpointName& name,
                                               const harness::Protocol& protocol) {
  const Result<Duration> floor = timing_floor(name);
  if (!floor) return floor.error();
  NetworkPorts ports = network_ports(name, protocol);
  Result<os::RemoteHost> host = os::RemoteHost::find(ports.host);
  if (!host)
    return fail(fmt::format("cannot open {}:{}: {}", name.kind, name.target, host.error().message));
  Capabilities can = capabilities_of(name);
  can.connections = ports.tcp != 0;
  can.datagrams = ports.udp != 0;
  can.timing_floor = *floor;
  return std::unique_ptr<Endpoint>(std::make_unique<SocketEndpoint>(
      description(name, ports), can, std::move(*host), ports, default_ports(protocol)));
}

}  // namespace fieldproof::endpoints
