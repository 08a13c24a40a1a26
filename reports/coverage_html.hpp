// Traceability as one HTML file, in the look of the run's report.
#pragma once

#include <string>

#include "reports/coverage.hpp"
#include "src/base/result.hpp"

namespace fieldproof::reports {

/// The page: what is covered, then each manual by section; a section opens to its statements, their
/// vectors and verdicts.
std::string coverage_html(const Coverage& coverage);

/// Writes it; `path` appears whole or not at all.
Status write_coverage_html(const Coverage& coverage, const std::string& path);

}  // namespace fieldproof::reports
