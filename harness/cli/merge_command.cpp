#include <fmt/format.h>
#include <fmt/ranges.h>
#include <filesystem>

#include "harness/cli/commands.hpp"
#include "harness/run/run_report.hpp"
#include "reports/compare/merge.hpp"
#include "reports/text/tally.hpp"

namespace fieldproof {

namespace {

Result<MergedRun> read_and_merge(const MergeOptions& options, const std::string& out) {
  std::vector<ResultFile> files;
  for (const std::string& path : options.files) {
    std::error_code ignored;
    if (std::filesystem::equivalent(path, out, ignored))
      return fail(
          fmt::format("the results would overwrite {}; name another folder with --out", path));
    Result<ResultFile> file = read_result_file(path);
    if (!file) return file.error();
    files.push_back(std::move(*file));
  }
  return merge_results(files);
}

Gate gate_of(const RunInfo& run) {
  const auto gate = run.properties.find("gate");
  return gate == run.properties.end() ? Gate{} : parse_gate(gate->second);
}

}  // namespace

int merge_command(const MergeOptions& options) {
  const std::string ndjson = (std::filesystem::path(options.out) / "results.ndjson").string();
  Result<MergedRun> merged = read_and_merge(options, ndjson);
  if (!merged) return complain(merged.error().message, exit_code::usage);
  merged->run.command = options.command;
  Result<ReportPaths> paths =
      make_report_paths(options.out, options.json, options.junit, options.html);
  if (!paths) return complain(paths.error().message, exit_code::trouble);
  Result<RunReport> report =
      RunReport::create(std::move(*paths), console_options(gate_of(merged->run), false));
  if (!report) return complain(report.error().message, exit_code::trouble);
  if (const Status begun = report->begin(merged->run); !begun)
    return complain(begun.error().message, exit_code::trouble);
  for (const CaseResult& result : merged->results)
    if (!report->add(result)) break;
  RunReport::End end;
  end.trouble = fmt::format("{}", fmt::join(merged->troubles, "; "));
  end.interrupted = merged->interrupted;
  end.worse = merged->failed;
  end.seconds = merged->seconds;
  return report->finish(end);
}

}  // namespace fieldproof
