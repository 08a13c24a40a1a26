// The trend of a device for the console, as Markdown and as JSON.
#pragma once

#include <string>

#include "reports/history/trend.hpp"

namespace fieldproof::history {

std::string trend_text(const Trend& trend);
std::string trend_markdown(const Trend& trend);
/// {"device", "runs": [{"run", "started", "firmware", "vectors", "counts", "red", "judged",
/// "response": {...} or null}], "topics": {"xgt_cnet/rss": [[run, median_ms], ...]}, "changes":
/// [{"series", "before", "after", "shift", "p", "corrected_p", "between": [run, run]}], "steps":
/// [{"outcome", "between"}], "flaky":
/// [{"id", "firmware", "vectors", "verdicts", "within"}], "test"}
std::string trend_json(const Trend& trend);

/// "24 runs, 2026-01-02 to 2026-11-23, firmware V1.40, V1.41".
std::string trend_head(const Trend& trend);
/// What was left out of it, a line each.
std::vector<std::string> trend_remarks(const Trend& trend);
/// "slower", "faster", "more", "fewer".
std::string direction_of(const Series& series);
/// "p 1.2e-05, corrected 0.0004, 12 runs before and 13 after".
std::string evidence_of(const Series& series);

}  // namespace fieldproof::history
