// What the head of the reports says of a run.
#pragma once

#include <string>
#include <vector>

#include "harness/bench/benches.hpp"
#include "harness/run/run_plan.hpp"
#include "reports/results/case_result.hpp"
#include "reports/text/tally.hpp"

namespace fieldproof::run {

results::Gate gate_of(const RunOptions& options);

/// `floors`: what the link of each port can show, in words; empty before it is measured.
results::RunInfo run_info(const RunOptions& options, const RunPlan& plan,
                          const std::vector<bench::Benches>& ports,
                          const std::vector<std::string>& floors);

}  // namespace fieldproof::run
