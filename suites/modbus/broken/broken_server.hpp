// A Modbus server with one known fault, so that the suite can be shown to find it.
#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string_view>

#include "src/plc/emulated_device.hpp"

namespace fieldproof::modbus_broken {

/// "rtu" or "ascii"; a server with the fault of that name, or without ("none"). `config` as of
/// make_modbus_plc. Errors name the mode, the fault or the parameter.
Result<std::unique_ptr<plc::EmulatedDevice>> make_broken_server(std::string_view mode,
                                                                std::string_view fault,
                                                                const nlohmann::json& config);

}  // namespace fieldproof::modbus_broken
