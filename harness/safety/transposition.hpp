// Moves a case into the words that may be written on a real device. Its addresses are replaced
// throughout: in memory, in frames to the device and in those that repeat them; lengths and checks
// follow. Type, number of digits, order, adjacency and the place in double and long words stay as
// they are.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "harness/safety/fence.hpp"
#include "harness/vectors/case.hpp"
#include "reports/results/case_result.hpp"

namespace fieldproof::safety {

/// Where a case must go so that it writes inside the fence; empty: it may stay. Errors say why it
/// cannot be moved: the end of an area, an area that is not allowed, an address that is no field of
/// its own, no room. `protocol` is configured as the device; `station` is its own.
Result<std::vector<results::Move>> plan_moves(const vectors::Case& source, int station,
                                              const WriteFence& fence,
                                              const harness::Protocol& protocol);

/// The case after these moves. Errors name the address that cannot be moved.
Result<vectors::Case> moved_case(const vectors::Case& source, int station,
                                 const std::vector<results::Move>& moves,
                                 const harness::Protocol& protocol);

/// "transposed: M100-M102 to M120-M122"
std::string note_of(const results::Move& move, const harness::Protocol& protocol);

}  // namespace fieldproof::safety
