#include <fmt/format.h>
#include <fmt/ranges.h>
#include <filesystem>

#include "harness/cli/commands.hpp"
#include "harness/run/run_report.hpp"
#include "reports/compare/merge.hpp"
#include "reports/text/tally.hpp"

namespace fieldproof::cli {

namespace {

Result<compare::MergedRun> read_and_merge(const MergeOptions& options, const std::string& out) {
  std::vector<compare::ResultFile> files;
  for (const std::string& path : options.files) {
    std::error_code ignored;
    if (std::filesystem::equivalent(path, out, ignored))
      return fail(
          fmt::format("the results would overwrite {}; name another folder with --out", path));
    Result<compare::ResultFile> file = compare::read_result_file(path);
    if (!file) return file.error();
    files.push_back(std::move(*file));
  }
  return compare::merge_results(files);
}

}  // namespace

int merge_command(const MergeOptions& options) {
  const std::string ndjson = (std::filesystem::path(options.out) / "results.ndjson").string();
  Result<compare::MergedRun> merged = read_and_merge(options, ndjson);
  if (!merged) return run::complain(merged.error().message, run::exit_code::usage);
  merged->run.command = options.command;
  Result<run::ReportPaths> paths =
      run::make_report_paths(options.out, options.json, options.junit, options.html);
  if (!paths) return run::complain(paths.error().message, run::exit_code::trouble);
  Result<run::RunReport> report = run::RunReport::create(
      std::move(*paths), run::console_options(text::gate_of(merged->run), false));
  if (!report) return run::complain(report.error().message, run::exit_code::trouble);
  if (const Status begun = report->begin(merged->run); !begun)
    return run::complain(begun.error().message, run::exit_code::trouble);
  for (const results::CaseResult& result : merged->results)
    if (!report->add(result)) break;
  run::RunReport::End end;
  end.trouble = fmt::format("{}", fmt::join(merged->troubles, "; "));
  end.interrupted = merged->interrupted;
  end.worse = merged->worse;
  end.seconds = merged->seconds;
  return report->finish(end);
}

}  // namespace fieldproof::cli
