// An emulated XGB PLC whose Ethernet module is XGT server (server.hpp).
#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string_view>

#include "src/base/result.hpp"
#include "src/plc/plc.hpp"
#include "src/xgt_fenet/server.hpp"

namespace fieldproof::xgt_fenet {

/// Reads given.config of a vector (vectors/README.md): connections, waiting_time, header_check,
/// base, slot, error. Errors name the key.
Result<ServerConfig> read_server_config(const nlohmann::json& config);

/// Puts the server on the module. Role client is refused.
Status add_server(plc::Plc& plc, const nlohmann::json& config);

/// A PLC in its power-on state with the server. Errors also name the model.
Result<std::unique_ptr<plc::EmulatedDevice>> make_plc(std::string_view model,
                                                      const nlohmann::json& config);

}  // namespace fieldproof::xgt_fenet
