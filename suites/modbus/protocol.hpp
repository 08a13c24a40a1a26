// Modbus RTU and ASCII servers of the XGB Cnet interface (Cnet EN 6.1.3 and chapter 9) for the
// harness.
#pragma once

#include "harness/protocol.hpp"

namespace fieldproof::modbus_suite {

const harness::Protocol& rtu();
const harness::Protocol& ascii();

}  // namespace fieldproof::modbus_suite
