// From vectors, and the results of a run, to traceability.
#pragma once

#include <optional>

#include "harness/vectors/fault_matrix.hpp"
#include "harness/vectors/loader.hpp"
#include "reports/compare/result_file.hpp"
#include "reports/coverage.hpp"

namespace fieldproof::cli {

/// Every manual with its statements, and the vectors that cite them. With `results`: what their
/// cases came to. `faults`: which cases a fault has turned red.
reports::Coverage trace(const vectors::VectorSet& set,
                        const std::optional<compare::ResultFile>& results,
                        const vectors::FaultMatrix& faults = {});

}  // namespace fieldproof::cli
