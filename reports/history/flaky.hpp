// Cases that come out now so, now so, though nothing was changed: same device, firmware and
// vectors.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "reports/history/history.hpp"
#include "reports/text/tally.hpp"

namespace fieldproof::history {

struct FlakyCase {
  std::string name, device, firmware, vectors;
  text::Tally verdicts;       // runs by verdict
  std::size_t within = 0;     // runs whose own repetitions differ
  std::int64_t last_odd = 0;  // the last run with another verdict than most; 0: none has
};

/// Only verdicts on the device count: what was skipped, blocked or could not be judged is no
/// change, and a waiver is none. The most evenly divided first.
Result<std::vector<FlakyCase>> flaky_cases(History& history, const std::vector<RunEntry>& runs);

/// "PASS in 7, FAIL in 3 of 10 runs; the last odd one is run 12"
std::string flaky_text(const FlakyCase& one);

}  // namespace fieldproof::history
