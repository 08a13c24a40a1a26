// The options that endpoints on real time have in common. parse_endpoint has refused those that a
// kind does not know.
#pragma once

#include "harness/endpoints/endpoint.hpp"
#include "harness/endpoints/serial_ports/serial_settings.hpp"
#include "src/line/settings.hpp"

namespace fieldproof::endpoints {

/// Differences in time below this cannot be judged: option floor_ms (0-10000), or 20 ms.
Result<Duration> timing_floor(const EndpointName& name);

/// May others reach the line, too? Option shared: on, or "off": its server takes this client alone.
bool is_shared(const EndpointName& name);

/// What a serial port is opened with: options baud (9600), frame (8N1), rs485 (none), floor_ms.
struct SerialOptions {
  line::LineSettings settings;
  Direction direction = Direction::none;
  Duration floor{};
};
Result<SerialOptions> serial_options(const EndpointName& name);

}  // namespace fieldproof::endpoints
