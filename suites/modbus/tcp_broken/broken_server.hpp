// A Modbus TCP server with one known fault, so that the suite can be shown to find it.
#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string_view>

#include "suites/modbus/tcp_broken/faults.hpp"

namespace fieldproof::modbus_tcp_broken {

/// `config` as of a Modbus TCP server. Errors name the model or the parameter.
Result<std::unique_ptr<plc::EmulatedDevice>> make_broken_server(const Behaviour& behaviour,
                                                                std::string_view model,
                                                                const nlohmann::json& config);

}  // namespace fieldproof::modbus_tcp_broken
