#include "harness/cli/compare_command.hpp"

#include <fmt/format.h>

#include "harness/cli/commands.hpp"
#include "harness/run/run_report.hpp"
#include "reports/compare/compare_html.hpp"
#include "reports/compare/compare_junit.hpp"
#include "reports/compare/compare_text.hpp"

namespace fieldproof {

Status report_comparison(const ComparisonSet& set, const std::string& html,
                         const std::string& junit) {
  print(compare_text(set));
  if (!html.empty())
    if (Status written = write_compare_html(set, html); !written) return written;
  if (!junit.empty())
    if (Status written = write_compare_junit(set, junit); !written) return written;
  return ok();
}

int compare_command(const CompareOptions& options) {
  std::vector<RunSummary> runs;
  for (const std::string& path : options.files) {
    const Result<ResultFile> file = read_result_file(path);
    if (!file) return complain(file.error().message, exit_code::usage);
    if (file->results.empty())
      return complain(fmt::format("cannot compare {}: there is no result in it", path),
                      exit_code::usage);
    runs.push_back(summarize(*file));
  }
  const ComparisonSet set(std::move(runs));
  if (const Status reported = report_comparison(set, options.html, options.junit); !reported)
    return complain(reported.error().message, exit_code::trouble);
  const int code = set.worse() ? exit_code::failed : exit_code::ok;
  print(fmt::format("\nexit {}: {}\n", code,
                    set.worse() ? "something got worse" : "nothing got worse"));
  return code;
}

}  // namespace fieldproof
