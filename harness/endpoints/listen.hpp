// listen:HOST:PORT: the device under test connects to the bench.
#pragma once

#include "harness/endpoints/endpoint.hpp"

namespace fieldproof::endpoints {

/// HOST is an address of this computer, 0.0.0.0 for all; without PORT it is that of the protocol.
/// Links are numbered from first_own_link; what the device has opened in one case stands in the
/// next. Options: udp (a port for datagrams, too), floor_ms, station, protocol.
Result<std::unique_ptr<Endpoint>> open_listen(const EndpointName& name,
                                              const harness::Protocol& protocol);

}  // namespace fieldproof::endpoints
