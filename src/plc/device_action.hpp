// What the back door can make a device do (emulated_device.hpp).
#pragma once

#include <string_view>

#include "src/base/result.hpp"

namespace fieldproof::plc {

enum class DeviceAction { run, stop, power_cycle };

/// "run", "stop" or "power_cycle"; the error lists them.
Result<DeviceAction> parse_device_action(std::string_view text);

}  // namespace fieldproof::plc
