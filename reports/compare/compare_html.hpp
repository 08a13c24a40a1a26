// A comparison as one HTML file, in the look of the run's report.
#pragma once

#include <string>

#include "reports/compare/compare.hpp"
#include "src/base/result.hpp"

namespace fieldproof::compare {

/// The outcome and the runs at the top, what got worse first, reply times with the figures of their
/// test, and the matrix of all cases: rows that differ, then (folded) those that do not. `path`
/// appears whole or not at all.
Status write_compare_html(const ComparisonSet& set, const std::string& path);

}  // namespace fieldproof::compare
