#include "reports/history/matrix.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <unordered_map>
#include <unordered_set>

#include "reports/compare/compare.hpp"
#include "reports/history/device_choice.hpp"

namespace fieldproof::history {

using results::Verdict;

namespace {

/// Verdicts of a column by the id of the case.
using Verdicts = std::unordered_map<std::int64_t, Verdict>;

std::vector<MatrixColumn> columns_of(const std::vector<RunEntry>& runs, Columns by) {
  const bool one_device = devices_of(runs).size() == 1;
  std::vector<MatrixColumn> columns;
  for (const RunEntry& run : runs) {
    const std::string firmware = run.firmware.empty() ? "no firmware named" : run.firmware;
    const std::string name = by == Columns::device ? run.device
                             : one_device          ? firmware
                                                   : fmt::format("{}, {}", run.device, firmware);
    auto column = std::ranges::find(columns, name, &MatrixColumn::name);
    if (column == columns.end()) column = columns.insert(columns.end(), {name, {}, {}, {}});
    column->newest = run;
  }
  return columns;
}

/// The columns with the latest runs, in their order.
void leave_out_oldest(std::size_t last, Matrix& matrix) {
  if (last == 0 || matrix.columns.size() <= last) return;
  matrix.left_out = matrix.columns.size() - last;
  const auto age = [](const MatrixColumn& one) {
    return std::pair(one.newest.started_s, one.newest.number);
  };
  std::vector<std::pair<std::int64_t, std::int64_t>> ages;
  std::ranges::transform(matrix.columns, std::back_inserter(ages), age);
  std::ranges::sort(ages, std::ranges::greater());
  std::erase_if(matrix.columns, [&](const MatrixColumn& one) { return age(one) < ages[last - 1]; });
}

bool belongs(const RunEntry& run, const MatrixColumn& column, Columns by) {
  return run.device == column.newest.device && run.vectors == column.newest.vectors &&
         (by == Columns::device || run.firmware == column.newest.firmware);
}

/// The last run with each selection of cases tells all that is to be known.
Result<Verdicts> fill(History& history, const std::vector<RunEntry>& runs, Columns by,
                      MatrixColumn& column) {
  Verdicts verdicts;
  std::set<std::int64_t> seen;
  for (auto run = runs.rbegin(); run != runs.rend(); ++run) {
    if (!belongs(*run, column, by) || !seen.insert(run->cases).second) continue;
    const Result<Numbers> steps = history.list(run->cases), codes = history.list(run->verdicts);
    for (const auto* list : {&steps, &codes})
      if (!*list) return list->error();
    const Numbers ids = from_steps(*steps);
    bool is_new = false;
    for (std::size_t i = 0; i < std::min(ids.size(), codes->size()); ++i)
      if (const std::optional<Verdict> verdict = verdict_of((*codes)[i]))
        is_new |= verdicts.try_emplace(ids[i], *verdict).second;
    if (is_new) column.runs.push_back(run->number);
  }
  return verdicts;
}

void judge(MatrixRow& row) {
  std::optional<Verdict> first;
  for (const std::optional<Verdict>& cell : row.cells) {
    if (!cell || cell == Verdict::skip) continue;
    row.red |= results::gates(*cell, {});
    row.differs |= first && *first != *cell;
    first = cell;
  }
}

Status fill_sections(History& history, const MatrixOptions& options,
                     const std::vector<Verdicts>& verdicts, Matrix& matrix) {
  std::set<std::int64_t> all;
  for (const Verdicts& one : verdicts)
    for (const auto& [id, verdict] : one) all.insert(id);
  const Numbers ids(all.begin(), all.end());
  Result<std::vector<CaseFacts>> facts = history.cases(ids);
  if (!facts) return facts.error();
  std::map<html::SectionName, MatrixSection> sections;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    CaseFacts& one = (*facts)[i];
    if (options.wanted && !options.wanted(one.name)) continue;
    MatrixSection& section = sections[{one.manual, one.section}];
    section.name = {one.manual, one.section};
    section.tallies.resize(matrix.columns.size());
    MatrixRow row{std::move(one), {}, false, false};
    for (std::size_t c = 0; c < verdicts.size(); ++c) {
      const auto found = verdicts[c].find(ids[i]);
      row.cells.push_back(found == verdicts[c].end() ? std::nullopt : std::optional(found->second));
      if (!row.cells.back()) continue;
      section.tallies[c].add(*row.cells.back());
      matrix.columns[c].tally.add(*row.cells.back());
    }
    judge(row);
    section.rows.push_back(std::move(row));
  }
  for (auto& [name, section] : sections) {
    std::ranges::sort(section.rows, {}, [](const MatrixRow& row) { return row.facts.name; });
    matrix.sections.push_back(std::move(section));
  }
  return ok();
}

}  // namespace

std::size_t Matrix::cases() const {
  std::size_t count = 0;
  for (const MatrixSection& one : sections) count += one.rows.size();
  return count;
}

Result<Matrix> matrix_of(History& history, const MatrixOptions& options) {
  Result<std::vector<RunEntry>> runs = history.runs();
  if (!runs) return runs.error();
  if (!options.device.empty()) {
    const Result<std::string> device = find_device(*runs, options.device);
    if (!device) return device.error();
    std::erase_if(*runs, [&](const RunEntry& run) { return run.device != *device; });
  }
  Matrix matrix;
  matrix.columns = columns_of(*runs, options.by);
  leave_out_oldest(options.last, matrix);
  std::vector<Verdicts> verdicts;
  for (MatrixColumn& column : matrix.columns) {
    Result<Verdicts> filled = fill(history, *runs, options.by, column);
    if (!filled) return filled.error();
    verdicts.push_back(std::move(*filled));
  }
  if (const Status done = fill_sections(history, options, verdicts, matrix); !done)
    return done.error();
  if (matrix.cases() == 0)
    return fail(fmt::format("history {} has no such case; `fieldproof history list` shows its runs",
                            history.path()));
  return matrix;
}

std::string column_letter(std::size_t column) { return compare::ComparisonSet::letter(column); }

std::vector<const MatrixRow*> rows_with(const Matrix& matrix, bool MatrixRow::*flag) {
  std::vector<const MatrixRow*> rows;
  for (const MatrixSection& section : matrix.sections)
    for (const MatrixRow& row : section.rows)
      if (row.*flag) rows.push_back(&row);
  return rows;
}

std::string section_cell(const text::Tally& tally) {
  const std::size_t red = tally.gating({});
  const std::size_t judged = tally.judged() + tally.of(Verdict::error);
  if (judged == 0) return "-";
  return red == 0 ? std::to_string(judged) : fmt::format("{} red of {}", red, judged);
}

}  // namespace fieldproof::history
