// An emulated XGB PLC as Modbus server: RTU or ASCII on a Cnet channel (server.hpp), or TCP by its
// Ethernet module (tcp_server.hpp).
#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string_view>

#include "src/base/result.hpp"
#include "src/modbus/modbus_mode.hpp"
#include "src/modbus/tcp_server.hpp"
#include "src/plc/plc.hpp"

namespace fieldproof::modbus {

/// Puts the server on a channel, of no meaning for TCP. `config` is `given.config` of a vector
/// (vectors/README.md): bit_read_base, bit_write_base, word_read_base and word_write_base
/// (bases.hpp); for a channel the basic parameters of a port (src/plc/port_config.hpp), for TCP
/// those of `read_tcp_config`. Errors name the key or the base. Role client is refused: that is
/// p2p_driver.hpp.
Status add_modbus_server(plc::Plc& plc, ModbusMode mode, unsigned channel,
                         const nlohmann::json& config);

/// A PLC in its power-on state with the server on channel 1. Errors also name the model.
Result<std::unique_ptr<plc::EmulatedDevice>> make_modbus_plc(ModbusMode mode,
                                                             std::string_view model,
                                                             const nlohmann::json& config);

/// Reads connections (1-4, FEnet EN table 6-1) and waiting_time (seconds, 2-255; FEnet EN 6.2.2).
/// One that is absent leaves `to` as it is. Errors name the key.
Status read_tcp_config(const nlohmann::json& config, TcpServerConfig& to);

/// Of FEnet EN: four connections; a reception waiting time of 100 s (decision: no default is
/// printed).
TcpServerConfig fenet_server();

}  // namespace fieldproof::modbus
