// X-NET (XINJE) for the harness: a model of PLCs on their nets and of their axes, without frames,
// since the manual prints none. Cases set, do, wait and look; nothing is sent.
#pragma once

#include "harness/protocol.hpp"

namespace fieldproof::xnet_suite {

const harness::Protocol& protocol();

}  // namespace fieldproof::xnet_suite
