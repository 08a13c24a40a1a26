// The XGT dedicated protocol of the XGB Cnet interface (Cnet EN chapter 7) for the harness.
#pragma once

#include "harness/protocol.hpp"

namespace fieldproof::xgt_cnet_suite {

const harness::Protocol& protocol();

}  // namespace fieldproof::xgt_cnet_suite
