// The matrix of a history for the console, as Markdown and as JSON.
#pragma once

#include <string>

#include "reports/history/matrix.hpp"

namespace fieldproof::history {

/// Columns, the cases that differ or are red, and their sections; those that are alike are counted.
std::string matrix_text(const Matrix& matrix);
/// The same with all sections, and without a limit of rows.
std::string matrix_markdown(const Matrix& matrix);
/// {"columns": [...], "sections": [{"manual", "section", "cases": [{"id", "title", "differs",
/// "verdicts": [...]}]}]}, one verdict a column, null where no run has the case: all cases.
std::string matrix_json(const Matrix& matrix);

}  // namespace fieldproof::history
