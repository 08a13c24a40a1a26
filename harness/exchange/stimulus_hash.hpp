// What tells a recorded exchange from that of a vector that does something else by now.
#pragma once

#include <string>

#include "harness/exchange/prepared_case.hpp"

namespace fieldproof::exchange {

/// Of all that is done to the device: 16 hex digits. What is expected of it is left out: that may
/// change.
std::string stimulus_hash(const PreparedCase& prepared);

}  // namespace fieldproof::exchange
