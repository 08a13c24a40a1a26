// Devices or firmware versions side by side: the last verdict of each on each case.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "reports/history/history.hpp"
#include "reports/html/html_survey.hpp"

namespace fieldproof::history {

enum class Columns { device, firmware };

struct MatrixOptions {
  Columns by = Columns::device;
  std::string device;     // its name or a part of it; empty: all
  std::size_t last = 12;  // so many columns at most, those with the latest runs; 0: all
  std::function<bool(const std::string&)> wanted;  // cases by name; empty: all
};

struct MatrixColumn {
  std::string name;  // of the device, of the firmware, or both
  RunEntry newest;
  std::vector<std::int64_t> runs;  // that its verdicts are from, the newest first
  text::Tally tally;               // cases
};

struct MatrixRow {
  CaseFacts facts;
  std::vector<std::optional<results::Verdict>> cells;  // one a column; nothing: no run has the case
  bool differs = false;  // between columns that have it, SKIP left out: other profiles are no news
  bool red = false;      // in any
};

struct MatrixSection {
  html::SectionName name;
  std::vector<MatrixRow> rows;  // by name
  std::vector<text::Tally> tallies;
};

struct Matrix {
  std::vector<MatrixColumn> columns;
  std::vector<MatrixSection> sections;  // in the order in which a person counts
  std::size_t left_out = 0;             // columns
  std::size_t cases() const;
};

/// A column has each case as of the last run that has it, among the runs with the vectors of its
/// last run: so a run of a few cases hides nothing.
Result<Matrix> matrix_of(History& history, const MatrixOptions& options);

/// "A", "B", ...
std::string column_letter(std::size_t column);
/// Those for which `flag` holds, in the order of the sections.
std::vector<const MatrixRow*> rows_with(const Matrix& matrix, bool MatrixRow::*flag);
/// "118", or "2 red of 120", of what a column judged; "-": nothing.
std::string section_cell(const text::Tally& tally);

}  // namespace fieldproof::history
