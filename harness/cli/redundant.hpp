// `fieldproof list --redundant`: cases that no fault of our broken devices tells apart.
#pragma once

#include <string>

#include "harness/vectors/fault_matrix.hpp"
#include "harness/vectors/loader.hpp"

namespace fieldproof::cli {

/// The text that is printed.
std::string redundant_text(const vectors::VectorSet& set, const vectors::FaultMatrix& matrix);

}  // namespace fieldproof::cli
