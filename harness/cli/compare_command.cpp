#include "harness/cli/compare_command.hpp"

#include <fmt/format.h>

#include "harness/cli/commands.hpp"
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

int compare_command(const CompareOptions& options) {
  std::vector<compare::RunSummary> runs;
  for (const std::string& path : options.files) {
    const Result<compare::ResultFile> file = compare::read_result_file(path);
    if (!file) return run::complain(file.error().message, run::exit_code::usage);
    if (file->results.empty())
      return run::complain(fmt::format("cannot compare {}: there is no result in it", path),
                           run::exit_code::usage);
    runs.push_back(compare::summarize(*file));
  }
  const compare::ComparisonSet set(std::move(runs));
  if (const Status reported = report_comparison(set, options.html, options.junit); !reported)
    return run::complain(reported.error().message, run::exit_code::trouble);
  const int code = set.worse() ? run::exit_code::failed : run::exit_code::ok;
  run::tell(fmt::format("\nexit {}: {}\n", code,
                        set.worse() ? "something got worse" : "nothing got worse"));
  return code;
}

}  // namespace fieldproof::cli
