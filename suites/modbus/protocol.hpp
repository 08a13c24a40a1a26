// Modbus RTU and ASCII servers of the XGB Cnet interface (Cnet EN 6.1.3 and chapter 9), and Modbus
// TCP of the Ethernet modules of XGB (FEnet EN 5.3) and XINJE (X-NET 3-4-2), for the harness.
#pragma once

#include "harness/protocol.hpp"

namespace fieldproof::modbus_suite {

const harness::Protocol& rtu();
const harness::Protocol& ascii();
const harness::Protocol& tcp();

}  // namespace fieldproof::modbus_suite
