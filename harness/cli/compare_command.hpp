// Comparison of result files, for `compare` and for `run --baseline`.
#pragma once

#include <string>

#include "reports/compare/compare.hpp"
#include "src/base/result.hpp"

namespace fieldproof::cli {

/// Prints the comparison and writes the reports that are named; empty: not.
Status report_comparison(const compare::ComparisonSet& set, const std::string& html,
                         const std::string& junit);

}  // namespace fieldproof::cli
