// An emulated XINJE PLC with Ethernet (XDE, XD5E, XG): Modbus TCP server at port 502 (X-NET 3-4-2),
// or Modbus RTU slave at its serial port (1-1-2).
#pragma once

#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string_view>

#include "src/base/result.hpp"
#include "src/modbus/modbus_mode.hpp"
#include "src/plc/controller.hpp"
#include "src/xnet/memory.hpp"

namespace fieldproof::xnet {

/// The name of the model.
constexpr std::string_view xd = "xd";

class XinjePlc : public plc::Controller {
 public:
  explicit XinjePlc(bool run = true) : Controller(run) {}

  /// Puts a Modbus server on channel 1, or on the Ethernet: add_modbus_server.
  Status serve(modbus::ModbusMode mode, const nlohmann::json& config);
  Status set(std::string_view address, std::string_view hex) override;
  Result<std::string> get(std::string_view address, std::size_t digits) const override;

 private:
  Memory memory_;
};

/// Puts a Modbus server of `memory` on a channel (RTU), or on the Ethernet (TCP); the memory
/// outlives it, and `written` is called when all of a request is written. Coils stand behind both
/// tables of bits, registers behind both tables of words; an access lies inside one area. `config`:
/// for RTU src/plc/port_config.hpp; for TCP connections (4, X-NET 3-4-2; no waiting time is
/// printed, so there is none unless waiting_time is given). Errors name the key.
Status add_modbus_server(plc::Controller& plc, Memory& memory, std::function<void()> written,
                         modbus::ModbusMode mode, unsigned channel, const nlohmann::json& config);

/// In its power-on state, with that server on channel 1.
Result<std::unique_ptr<plc::EmulatedDevice>> make_xinje_plc(modbus::ModbusMode mode,
                                                            const nlohmann::json& config);

}  // namespace fieldproof::xnet
