#include "harness/cli/run_baseline.hpp"

#include <fmt/format.h>
#include <filesystem>
#include <set>

#include "harness/cli/compare_command.hpp"
#include "harness/cli/last_run.hpp"

namespace fieldproof::cli {

using compare::RunSummary;
using run::RunOptions;
using run::RunPlan;
using run::RunReport;

namespace {

std::set<std::string> selected_ids(const RunPlan& plan) {
  std::set<std::string> selected;
  for (const vectors::Case* one : plan.selected) selected.insert(one->id);
  return selected;
}

}  // namespace

void compare_with(const RunSummary& baseline, RunSummary now, const RunOptions& options,
                  RunReport& report, RunReport::End& end) {
  now.end = report.ended(end);
  const compare::ComparisonSet set({baseline, now});
  const std::filesystem::path out = options.out;
  const std::string html = (out / "compare.html").string(), junit = (out / "compare.xml").string();
  if (const Status reported = report_comparison(set, html, junit); !reported) {
    end.trouble += (end.trouble.empty() ? "" : "; ") + reported.error().message;
  } else {
    report.add_path("compare", html);
    report.add_path("compare", junit);
  }
  if (set.worse())
    end.worse = fmt::format("worse than {}: {}", baseline.path, outcome(set.comparisons.front()));
}

Result<std::optional<RunSummary>> baseline_of_file(const RunOptions& options, const RunPlan& plan) {
  if (options.baseline.empty() || options.baseline == last_run) return std::optional<RunSummary>();
  Result<compare::ResultFile> file = compare::read_result_file(options.baseline);
  if (!file) return file.error();
  const std::set<std::string> selected = selected_ids(plan);
  std::erase_if(file->results,
                [&](const results::CaseResult& one) { return !selected.contains(one.id); });
  return std::optional(compare::summarize(*file));
}

Result<std::optional<RunSummary>> baseline_of_history(const RunOptions& options,
                                                      const RunPlan& plan,
                                                      const results::RunInfo& info,
                                                      RunReport& report) {
  RunSummary now;
  now.run = info;
  Result<std::optional<RunSummary>> last = last_before(options.history, now, use_of(options));
  if (!last) return last;
  if (!*last) {
    report.say(no_run_before(options.history, now));
    return last;
  }
  const std::set<std::string> selected = selected_ids(plan);
  std::erase_if((*last)->cases, [&](const auto& one) {  // "ID [38400-8N1]" is of ID
    return !selected.contains(one.first.substr(0, one.first.find(" [")));
  });
  return last;
}

void add_to_history(const RunOptions& options, RunSummary now, RunReport& report,
                    RunReport::End& end) {
  if (options.history.empty() || now.cases.empty()) return;
  now.end = report.ended(end);
  Result<history::History> history = history::History::open(options.history, history::Use::write);
  const auto added = history ? history->add(now) : Result<history::History::Added>(history.error());
  if (added)
    report.add_path("history", fmt::format("{}, run {}", options.history, added->number));
  else
    end.trouble += (end.trouble.empty() ? "" : "; ") + added.error().message;
}

}  // namespace fieldproof::cli
