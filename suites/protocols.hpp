// The table of protocols.
#pragma once

#include "harness/protocols.hpp"

namespace fieldproof {

Protocols protocols();

}  // namespace fieldproof
