// The high-speed link (FEnet EN chapter 8) for the harness: a model of stations that exchange
// blocks, without frames. Cases set, wait and look; nothing is sent.
#pragma once

#include "harness/protocol.hpp"

namespace fieldproof::hs_link_suite {

const harness::Protocol& protocol();

}  // namespace fieldproof::hs_link_suite
