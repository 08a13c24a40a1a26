// The runs of a history, and one of them, in words.
#pragma once

#include <string>
#include <vector>

#include "reports/history/history.hpp"

namespace fieldproof::history {

/// The newest `last` runs, the newest first; 0: all.
std::string list_text(const std::vector<RunEntry>& runs, std::size_t last);
/// All, the oldest first: [{"run", "started", "device", "firmware", ...}].
std::string list_json(const std::vector<RunEntry>& runs);

/// What it was about, what did not hold, and its reply times.
std::string show_text(const RunEntry& entry, const compare::RunSummary& run);
/// {"run", "device", "info", "end", "counts", "cases": [...]}: all of its cases.
std::string show_json(const RunEntry& entry, const compare::RunSummary& run);

}  // namespace fieldproof::history
