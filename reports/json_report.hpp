// The whole run as one JSON document.
#pragma once

#include <memory>
#include <string>

#include "reports/results/sink.hpp"

namespace fieldproof::reports {

/// Writes `path`:
///   {"schema": 1, "run": {...}, "counts": {"total": 2, "PASS": 1, ... one a verdict},
///    "cases": [...], "end": {...}}
/// `end` is null when the run was killed. One case a line. `path` appears at the end, whole or not
/// at all.
std::unique_ptr<results::Sink> json_report(const std::string& path);

}  // namespace fieldproof::reports
