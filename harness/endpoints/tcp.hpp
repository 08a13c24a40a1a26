// tcp:HOST:PORT: a raw byte stream to a serial server or to a device emulated behind a socket.
// udp:HOST:PORT: datagrams to a device and from it.
#pragma once

#include "harness/endpoints/endpoint.hpp"

namespace fieldproof::endpoints {

/// HOST is a name, an IPv4 address or an IPv6 address in brackets. Options: floor_ms, station,
/// protocol. A connection that the far end closed is opened again at the begin of the next case.
Result<std::unique_ptr<Endpoint>> open_tcp(const EndpointName& name);

/// The same with datagrams: one send is one, and one burst is one (up to 4096 bytes). Nothing is
/// sent at opening: that nothing listens there shows with the first answer that does not come (an
/// error, where the host says so).
Result<std::unique_ptr<Endpoint>> open_udp(const EndpointName& name);

}  // namespace fieldproof::endpoints
