// A XINJE PLC on its nets as a bench reaches it: through its Modbus server, RTU at a serial port
// (X-NET 1-1-2) or TCP at the Ethernet (3-4-2). What else is on the nets runs beside it.
#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string_view>

#include "src/modbus/modbus_mode.hpp"
#include "src/plc/emulated_device.hpp"

namespace fieldproof::xnet {

/// `config`: keys of a PLC on X-NET (configuration.hpp) and of its Modbus server
/// (src/xnet/plc.hpp). Its bus end joins a PLC in another process. Errors name the key.
Result<std::unique_ptr<plc::EmulatedDevice>> make_served_plc(modbus::ModbusMode mode,
                                                             std::string_view model,
                                                             const nlohmann::json& config);

}  // namespace fieldproof::xnet
