// An emulated XGB PLC as Modbus RTU or ASCII server: one model's memory behind one Cnet channel
// (Cnet EN and KO 6.1.3 and chapter 9; DECISIONS.md 'Modbus RTU and ASCII').
//
// It answers in RUN and STOP, and to its own station alone: a request to station 0 draws silence
// from any other server and changes nothing. What draws silence is counted (service_status in
// src/plc/counters.hpp); an exception is a service. The reply is due when the end of the request is
// known, and after the delay: in RTU that is the inter-character time and one character after its
// last byte (rtu_receiver.hpp).
#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string_view>

#include "src/base/result.hpp"
#include "src/modbus/modbus_mode.hpp"
#include "src/plc/emulated_device.hpp"

namespace fieldproof::modbus {

/// In its power-on state. `config` is `given.config` of a vector (vectors/README.md) with the basic
/// parameters of a port (src/plc/port_config.hpp) and bit_read_base, bit_write_base, word_read_base
/// and word_write_base (bases.hpp). Errors name the model, the key or the base. Role client is
/// refused: that is p2p_driver.hpp.
Result<std::unique_ptr<plc::EmulatedDevice>> make_modbus_plc(ModbusMode mode,
                                                             std::string_view model,
                                                             const nlohmann::json& config);

}  // namespace fieldproof::modbus
