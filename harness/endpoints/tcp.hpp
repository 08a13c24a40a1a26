// tcp:HOST:PORT: a raw byte stream to a serial server or to a device emulated behind a socket.
#pragma once

#include "harness/endpoints/endpoint.hpp"

namespace fieldproof {

/// HOST is a name, an IPv4 address or an IPv6 address in brackets. Options: floor_ms, station, protocol.
/// A connection that the far end closed is opened again at the begin of the next case.
Result<std::unique_ptr<Endpoint>> open_tcp(const EndpointName& name);

}  // namespace fieldproof
