// The matrix of a history as one HTML file, in the look of the other reports.
#pragma once

#include <string>

#include "reports/history/matrix.hpp"

namespace fieldproof::history {

/// What differs first, then what is red everywhere, then all cases by section, folded. No script,
/// no network.
std::string matrix_html(const Matrix& matrix);

}  // namespace fieldproof::history
