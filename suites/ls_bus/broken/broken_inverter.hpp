// An inverter with one known fault, so that the suite can be shown to find it.
#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string_view>

#include "src/plc/emulated_device.hpp"

namespace fieldproof::ls_bus_broken {

/// An inverter with the fault of that name, or without ("none"). `config` as of make_inverter.
/// Errors name the fault or the key.
Result<std::unique_ptr<plc::EmulatedDevice>> make_broken_inverter(std::string_view fault,
                                                                  const nlohmann::json& config);

}  // namespace fieldproof::ls_bus_broken
