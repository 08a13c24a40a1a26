// tcp:HOST[:PORT] and udp:HOST[:PORT]: a device on a network, or a serial server.
#pragma once

#include "harness/endpoints/endpoint.hpp"

namespace fieldproof::endpoints {

/// HOST is a name, an IPv4 address or an IPv6 address in brackets. For a protocol that runs on a
/// network: links, see open_network; PORT may be left out. For the others one line: a raw byte
/// stream to a serial server or to a device emulated behind a socket. A line that the far end has
/// closed is opened again at the begin of the next case, and line_errors() says so. Options:
/// floor_ms, station, protocol, line=raw (one line; so it is where it is left out).
Result<std::unique_ptr<Endpoint>> open_tcp(const EndpointName& name,
                                           const harness::Protocol& protocol);

/// The same with datagrams. As one line one send is one datagram, and one burst is one (up to 4096
/// bytes); nothing is sent at opening: that nothing listens there shows with the first answer that
/// does not come (an error, where the host says so).
Result<std::unique_ptr<Endpoint>> open_udp(const EndpointName& name,
                                           const harness::Protocol& protocol);

}  // namespace fieldproof::endpoints
