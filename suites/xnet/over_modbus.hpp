// X-NET on a real PLC: no manual prints its frames, so the PLC is seen through what it serves,
// Modbus RTU on a serial port or Modbus TCP (X-NET 1-1-2, 3-4-2). Objects are set and read there;
// an instruction is executed by the PLC's own program, at a relay that the profile names
// (`config.program`).
#pragma once

#include "harness/protocol.hpp"

namespace fieldproof::xnet_suite {

/// It is called "xnet": its cases are those of X-NET.
const harness::Protocol& over_modbus_rtu();
const harness::Protocol& over_modbus_tcp();

}  // namespace fieldproof::xnet_suite
