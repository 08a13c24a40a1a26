// The whole run as one JSON document, from a file of results.
#pragma once

#include <string>

#include "reports/text/tally.hpp"
#include "src/base/result.hpp"

namespace fieldproof::reports {

/// Reads the results in `ndjson` (of a killed run too) and writes `path`:
///   {"schema": 1, "run": {...}, "counts": {"total": 2, "PASS": 1, ... one a verdict},
///    "cases": [...], "end": {...}}
/// `end` is null when the run was killed. One case a line; memory does not grow with their number.
/// `path` appears whole or not at all. Returns the counts of what was written.
Result<text::Tally> write_json(const std::string& ndjson, const std::string& path);

}  // namespace fieldproof::reports
