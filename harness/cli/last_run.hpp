// The word `last` of `run --baseline` and `compare`: the last run of the same device in a history.
#pragma once

#include <optional>
#include <string>

#include "harness/run/run_options.hpp"
#include "reports/history/history.hpp"

namespace fieldproof::cli {

inline constexpr const char* last_run = "last";

/// Where the history is: the file that is named, else the user's own.
Result<std::string> history_path(const std::string& named);

/// A run that is added may be the first of its history; one that is only compared needs one.
history::Use use_of(const run::RunOptions& options);

/// Before anything is sent: can the history that a run needs be used?
Status check_history(const run::RunOptions& options);

/// Nothing where there is none. `history`: as `history_path` takes it.
Result<std::optional<compare::RunSummary>> last_before(const std::string& history,
                                                       const compare::RunSummary& run,
                                                       history::Use use);
/// What to say then.
std::string no_run_before(const std::string& history, const compare::RunSummary& run);

}  // namespace fieldproof::cli
