// Where nothing answers at the start of a run: does somebody else, or otherwise?
#pragma once

#include <string>
#include <vector>

#include "harness/bench/benches.hpp"
#include "harness/probe/plan.hpp"
#include "harness/run/run_plan.hpp"

namespace fieldproof::run {

/// Why a run cannot start, with what the line shows besides. Where nothing answered on a line, it
/// is looked on for 3 s at most by the probe's harmless reads: the station as it reads in hex or in
/// decimal, the other protocols of the profile, other stations. The message says what was found and
/// the option that changes it, or what was tried. Any other error stays as it is.
Error looked_on(Error why, const bench::Benches& port, const DutPlan& plan);

/// What a search asks where `asked` at `station` was silent, the most likely first. Pure.
std::vector<probe::Trial> trials_instead_of(const harness::Protocol& asked, int station,
                                            const std::vector<const harness::Protocol*>& others,
                                            const line::LineSettings& line);

/// "0 to 3, 7".
std::string ranges_of(std::vector<int> numbers);

}  // namespace fieldproof::run
