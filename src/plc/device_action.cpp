#include "src/plc/device_action.hpp"

#include <fmt/format.h>

#include <array>

#include "src/base/spelling.hpp"

namespace fieldproof::plc {

Result<DeviceAction> parse_device_action(std::string_view text) {
  if (text == "run") return DeviceAction::run;
  if (text == "stop") return DeviceAction::stop;
  if (text == "power_cycle") return DeviceAction::power_cycle;
  constexpr std::array<std::string_view, 3> names{"run", "stop", "power_cycle"};
  return fail(fmt::format("cannot do '{}': there is no such action; use run, stop or power_cycle{}",
                          text, suggestion(text, names)));
}

}  // namespace fieldproof::plc
