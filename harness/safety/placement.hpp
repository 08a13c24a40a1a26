// A case on a device that declares where its memory lies: what the vector calls an address is asked
// for where the device holds it.
#pragma once

#include <optional>

#include "harness/exchange/prepared_case.hpp"
#include "harness/protocol.hpp"

namespace fieldproof::safety {

/// The same case with its memory (given, set, check) as the declared device names it; nothing where
/// that is no other. `declared`: Protocol::configured. Errors say what ties the case to the place
/// where the vector has it.
Result<std::optional<vectors::Case>> placed_case(const exchange::PreparedCase& prepared,
                                                 const harness::Protocol& declared);

}  // namespace fieldproof::safety
