// Where a device on a network is: what stands behind tcp:, udp: and listen:.
#pragma once

#include <cstdint>

#include "harness/endpoints/endpoint.hpp"

namespace fieldproof::endpoints {

/// Host and port can be read, and so can the options `udp` and `line`. Errors say what to write.
Status check_network_name(const EndpointName& name);
/// With this protocol: its port is known, and it is not made one line where it needs links.
Status check_network_use(const EndpointName& name, const harness::Protocol& protocol);
/// The same as check_network_name for a port that the bench listens on, which may be 0: any that is
/// free.
Status check_listen_name(const EndpointName& name);

/// The way to a device, or the bench's own side of it. 0: not over this transport.
struct NetworkPorts {
  std::string host;
  std::uint16_t tcp = 0, udp = 0;

  std::uint16_t of(Transport transport) const { return transport == Transport::tcp ? tcp : udp; }
};
/// Of the protocol's servers, without a host.
NetworkPorts default_ports(const harness::Protocol& protocol);
/// Of a name that has been checked. The target's port, or that of the protocol, is the one of the
/// kind; option `udp` adds datagrams to connections.
NetworkPorts network_ports(const EndpointName& name, const harness::Protocol& protocol);

}  // namespace fieldproof::endpoints
