#include "harness/cli/compare_command.hpp"

#include <fmt/format.h>

#include "harness/cli/commands.hpp"
#include "harness/cli/last_run.hpp"
#include "harness/run/run_report.hpp"
#include "reports/compare/compare_html.hpp"
#include "reports/compare/compare_junit.hpp"
#include "reports/compare/compare_text.hpp"

namespace fieldproof::cli {

Status report_comparison(const compare::ComparisonSet& set, const std::string& html,
                         const std::string& junit) {
  run::tell(compare::compare_text(set));
  if (!html.empty())
    if (Status written = compare::write_compare_html(set, html); !written) return written;
  if (!junit.empty())
    if (Status written = compare::write_compare_junit(set, junit); !written) return written;
  return ok();
}

namespace {

Result<std::vector<compare::RunSummary>> read_runs(const CompareOptions& options) {
  const bool from_history = options.files.front() == last_run;
  std::vector<compare::RunSummary> runs;
  for (std::size_t i = from_history ? 1 : 0; i < options.files.size(); ++i) {
    const Result<compare::ResultFile> file = compare::read_result_file(options.files[i]);
    if (!file) return file.error();
    if (file->results.empty())
      return fail(fmt::format("cannot compare {}: there is no result in it", options.files[i]));
    runs.push_back(compare::summarize(*file));
  }
  if (!from_history) return runs;
  Result<std::optional<compare::RunSummary>> last =
      last_before(options.history, runs.front(), history::Use::read);
  if (!last) return last.error();
  if (!*last) return fail(no_run_before(options.history, runs.front()));
  runs.insert(runs.begin(), std::move(**last));
  return runs;
}

}  // namespace

int compare_command(const CompareOptions& options) {
  Result<std::vector<compare::RunSummary>> runs = read_runs(options);
  if (!runs) return run::complain(runs.error().message, run::exit_code::usage);
  const compare::ComparisonSet set(std::move(*runs));
  if (const Status reported = report_comparison(set, options.html, options.junit); !reported)
    return run::complain(reported.error().message, run::exit_code::trouble);
  const int code = set.worse() ? run::exit_code::failed : run::exit_code::ok;
  run::tell(fmt::format("\nexit {}: {}\n", code,
                        set.worse() ? "something got worse" : "nothing got worse"));
  return code;
}

}  // namespace fieldproof::cli
