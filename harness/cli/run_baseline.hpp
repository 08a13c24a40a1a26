// What a run is compared with at its end, and where it is kept: `run --baseline`, `run --history`.
#pragma once

#include <optional>

#include "harness/run/run_options.hpp"
#include "harness/run/run_plan.hpp"
#include "harness/run/run_report.hpp"
#include "reports/compare/compare.hpp"
#include "src/base/result.hpp"

namespace fieldproof::cli {

/// Of the file that --baseline names, the results of the selected cases. Nothing where it names
/// none.
Result<std::optional<compare::RunSummary>> baseline_of_file(const run::RunOptions& options,
                                                            const run::RunPlan& plan);

/// The same of the last run that the history has of this device; says so where there is none.
Result<std::optional<compare::RunSummary>> baseline_of_history(const run::RunOptions& options,
                                                               const run::RunPlan& plan,
                                                               const results::RunInfo& info,
                                                               run::RunReport& report);

/// Prints and writes the comparison; what got worse goes into `end`.
void compare_with(const compare::RunSummary& baseline, compare::RunSummary now,
                  const run::RunOptions& options, run::RunReport& report, run::RunReport::End& end);

/// Where --history asks for it, and there is a result. What fails goes into `end`.
void add_to_history(const run::RunOptions& options, compare::RunSummary now, run::RunReport& report,
                    run::RunReport::End& end);

}  // namespace fieldproof::cli
