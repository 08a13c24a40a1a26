// The XGT dedicated protocol of the Ethernet module (FEnet EN 5.2, 6.3) for the harness.
#pragma once

#include "harness/protocol.hpp"

namespace fieldproof::xgt_fenet_suite {

const harness::Protocol& protocol();

}  // namespace fieldproof::xgt_fenet_suite
