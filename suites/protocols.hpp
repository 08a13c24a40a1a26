// The table of protocols.
#pragma once

#include "harness/protocols.hpp"

namespace fieldproof::suites {

harness::Protocols protocols();

}  // namespace fieldproof::suites
