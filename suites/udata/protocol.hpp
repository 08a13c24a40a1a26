// What UDATA instructions send and receive (Cnet KO 6.6), for the harness: raw bytes without a
// frame. Models: PLCs whose port runs such instructions, and the modem of Cnet KO 11.5.
#pragma once

#include "harness/protocol.hpp"

namespace fieldproof::udata_suite {

const harness::Protocol& protocol();

}  // namespace fieldproof::udata_suite
