#include <fmt/format.h>
#include <charconv>

#include "harness/cli/commands.hpp"
#include "harness/cli/last_run.hpp"
#include "harness/run/run_report.hpp"
#include "harness/vectors/filter.hpp"
#include "reports/history/device_choice.hpp"
#include "reports/history/matrix_html.hpp"
#include "reports/history/matrix_text.hpp"
#include "reports/history/run_list.hpp"
#include "reports/history/trend_html.hpp"
#include "reports/history/trend_text.hpp"
#include "reports/text/report_file.hpp"

namespace fieldproof::cli {

using history::History;
using history::RunEntry;
using history::Use;

namespace {

Result<History> open(const HistoryOptions& options, Use use) {
  const Result<std::string> path = history_path(options.file);
  if (!path) return path.error();
  return History::open(*path, use);
}

std::size_t last_of(const HistoryOptions& options, std::size_t usual) {
  return options.last < 0 ? usual : static_cast<std::size_t>(options.last);
}

int usage(const Error& error) { return run::complain(error.message, run::exit_code::usage); }

/// Prints, and writes the HTML file where one is named.
int deliver(const HistoryOptions& options, const std::string& text, const auto& html) {
  if (!options.html.empty()) {
    auto file = text::ReportFile::create(options.html);
    if (!file) return run::complain(file.error().message, run::exit_code::trouble);
    file->out() << html();
    if (const Status written = file->commit(); !written)
      return run::complain(written.error().message, run::exit_code::trouble);
  }
  run::print(text);
  return run::exit_code::ok;
}

/// Of the device that is asked for.
Result<std::vector<RunEntry>> runs_of(History& history, const std::string& device) {
  Result<std::vector<RunEntry>> runs = history.runs();
  if (!runs || device.empty()) return runs;
  const Result<std::string> name = history::find_device(*runs, device);
  if (!name) return name.error();
  std::erase_if(*runs, [&](const RunEntry& run) { return run.device != *name; });
  return runs;
}

Result<RunEntry> find_run(const std::vector<RunEntry>& runs, const std::string& name) {
  if (name == last_run && !runs.empty()) return runs.back();
  std::int64_t number = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
  if (error == std::errc() && end == name.data() + name.size())
    for (const RunEntry& run : runs)
      if (run.number == number) return run;
  return fail(
      fmt::format("the history has no run '{}'; `fieldproof history list` shows them", name));
}

}  // namespace

int history_add_command(const HistoryOptions& options) {
  std::vector<compare::RunSummary> runs;  // all are read before the first is added
  for (const std::string& path : options.results) {
    const Result<compare::ResultFile> file = compare::read_result_file(path);
    if (!file) return usage(file.error());
    runs.push_back(compare::summarize(*file));
  }
  Result<History> history = open(options, Use::write);
  if (!history) return usage(history.error());
  for (const compare::RunSummary& run : runs) {
    const Result<History::Added> added = history->add(run);
    if (!added) return run::complain(added.error().message, run::exit_code::trouble);
    run::print(fmt::format("{}: run {}{}, {}: {}\n", run.path, added->number,
                           added->is_new ? "" : ", which was there already", added->device,
                           text::to_string(run.tally)));
  }
  return run::exit_code::ok;
}

int history_list_command(const HistoryOptions& options) {
  Result<History> history = open(options, Use::read);
  if (!history) return usage(history.error());
  const Result<std::vector<RunEntry>> runs = runs_of(*history, options.device);
  if (!runs) return usage(runs.error());
  run::print(options.json ? history::list_json(*runs)
                          : history::list_text(*runs, last_of(options, 20)));
  return run::exit_code::ok;
}

int history_show_command(const HistoryOptions& options) {
  Result<History> history = open(options, Use::read);
  if (!history) return usage(history.error());
  const Result<std::vector<RunEntry>> runs = runs_of(*history, options.device);
  if (!runs) return usage(runs.error());
  const Result<RunEntry> entry = find_run(*runs, options.run);
  if (!entry) return usage(entry.error());
  const Result<compare::RunSummary> run = history->summary(entry->number);
  if (!run) return usage(run.error());
  run::print(options.json ? history::show_json(*entry, *run) : history::show_text(*entry, *run));
  return run::exit_code::ok;
}

int history_matrix_command(const HistoryOptions& options) {
  Result<History> history = open(options, Use::read);
  if (!history) return usage(history.error());
  history::MatrixOptions asked;
  asked.by = options.by == "firmware" ? history::Columns::firmware : history::Columns::device;
  asked.device = options.device;
  asked.last = last_of(options, asked.last);
  if (!options.filter.empty())
    asked.wanted = [&](const std::string& id) {
      return vectors::matches_filter(id, options.filter);
    };
  const Result<history::Matrix> matrix = history::matrix_of(*history, asked);
  if (!matrix) return usage(matrix.error());
  return deliver(options,
                 options.json       ? history::matrix_json(*matrix)
                 : options.markdown ? history::matrix_markdown(*matrix)
                                    : history::matrix_text(*matrix),
                 [&] { return history::matrix_html(*matrix); });
}

int history_trend_command(const HistoryOptions& options) {
  Result<History> history = open(options, Use::read);
  if (!history) return usage(history.error());
  const Result<history::Trend> trend =
      history::trend_of(*history, options.device, last_of(options, 0));
  if (!trend) return usage(trend.error());
  return deliver(options,
                 options.json       ? history::trend_json(*trend)
                 : options.markdown ? history::trend_markdown(*trend)
                                    : history::trend_text(*trend),
                 [&] { return history::trend_html(*trend); });
}

}  // namespace fieldproof::cli
