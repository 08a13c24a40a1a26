// The LS Bus between an XGB and LS inverters (Cnet EN and KO chapter 8) for the harness. The device
// under test is the inverter.
#pragma once

#include "harness/protocol.hpp"

namespace fieldproof::ls_bus_suite {

const harness::Protocol& protocol();

}  // namespace fieldproof::ls_bus_suite
