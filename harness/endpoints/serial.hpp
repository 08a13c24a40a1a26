// serial:PATH: a real adapter (RS-232, RS-422, RS-485), or a pty that stands in for one.
#pragma once

#include "harness/endpoints/endpoint.hpp"
#include "harness/system/system_calls.hpp"

namespace fieldproof::endpoints {

/// Options: baud (default 9600), frame (8N1), rs485 (1: the driver switches the direction, rts: the
/// bench does by RTS), floor_ms (default 20), station, protocol, echo (echo.hpp). The port is
/// opened for this process alone and its input flushed once. On a real port capabilities().wire is
/// true and character times are those of the settings; on a pty wire is false.
Result<std::unique_ptr<Endpoint>> open_serial(const EndpointName& name);

/// The same with a driver that a test stands in for.
Result<std::unique_ptr<Endpoint>> open_serial(const EndpointName& name,
                                              const os::SystemCalls& calls);

}  // namespace fieldproof::endpoints
