#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "harness/bench/files/waivers.hpp"
#include "harness/bench/rejudge.hpp"
#include "harness/bench/set_up_findings.hpp"
#include "harness/cli/commands.hpp"
#include "harness/paths.hpp"
#include "harness/run/run_report.hpp"
#include "harness/run/timestamp.hpp"
#include "harness/run/tool_vectors.hpp"
#include "reports/compare/result_file.hpp"
#include "reports/text/case_text.hpp"
#include "reports/text/xml_text.hpp"

namespace fieldproof::cli {

namespace {

/// Everything that is settled before the first case is judged.
struct JudgePlan {
  compare::ResultFile recorded;
  std::vector<const results::CaseResult*> selected;  // into `recorded`
  vectors::VectorSet vectors;
  bench::Profile profile;
  std::vector<bench::Waiver> waivers;
  results::Gate gate;
};

/// As the run was judged, and stricter where an option says so.
results::Gate gate_of(const JudgeOptions& options, const results::RunInfo& run) {
  results::Gate gate = text::gate_of(run);
  gate.strict |= options.strict;
  gate.qualify |= options.qualify;
  gate.fail_on_marginal |= options.fail_on_marginal;
  if (options.min_judged > 0) gate.min_judged = options.min_judged;
  return gate;
}

/// A filter for the vectors of these cases, and those beside them.
std::string folders_of(const std::vector<results::CaseResult>& recorded) {
  std::set<std::string> folders;
  for (const results::CaseResult& one : recorded)
    folders.insert(one.id.substr(0, one.id.find('/')) + "/*");
  return fmt::format("{}", fmt::join(folders, ":"));
}

Result<JudgePlan> make_judge_plan(const JudgeOptions& options,
                                  const harness::Protocols& protocols) {
  JudgePlan plan;
  Result<compare::ResultFile> recorded = compare::read_result_file(options.file);
  if (!recorded) return recorded.error();
  plan.recorded = std::move(*recorded);
  const std::string profile_name =
      options.profile.empty() ? plan.recorded.run.profile : options.profile;
  Result<bench::Profile> profile = bench::load_profile(profile_name, harness::find_data().profiles);
  if (!profile)
    return fail(fmt::format(
        "cannot judge {} by the profile it was recorded with: {}; name one with --profile",
        options.file, profile.error().message));
  plan.profile = std::move(*profile);
  // A waiver may name any case.
  Result<vectors::VectorSet> vectors = run::load_sound_vectors(
      options.vectors, protocols,
      options.waivers.empty() ? folders_of(plan.recorded.results) : std::string());
  if (!vectors) return vectors.error();
  plan.vectors = std::move(*vectors);
  if (const Status exist = run::check_decisions(plan.profile, plan.vectors); !exist)
    return exist.error();
  Result<std::vector<bench::Waiver>> waivers = bench::load_waivers(options.waivers);
  if (!waivers) return waivers.error();
  plan.waivers = std::move(*waivers);
  // What a run said about its waivers is said anew.
  for (const results::CaseResult& one : plan.recorded.results)
    if (!one.id.starts_with(bench::waiver_result) &&
        vectors::matches_filter(one.id, options.filter))
      plan.selected.push_back(&one);
  plan.gate = gate_of(options, plan.recorded.run);
  return plan;
}

/// The recorded run as it is judged today.
results::RunInfo info_of(const JudgeOptions& options, const JudgePlan& plan) {
  results::RunInfo info = plan.recorded.run;
  info.properties["recorded_in"] = options.file;
  info.properties["recorded_by"] = info.tool_version;
  info.properties["recorded_vectors"] = info.vectors_hash;
  info.properties["judged"] = run::timestamp();
  info.properties["gate"] = text::to_string(plan.gate);
  info.tool_version = FIELDPROOF_VERSION;
  info.profile = plan.profile.name;
  info.command = options.command;
  info.vectors_hash = plan.vectors.hash;
  return info;
}

std::string replay_command(const JudgeOptions& options) {
  std::string command = "fieldproof judge " + run::shell_word(options.file);
  if (!options.profile.empty()) command += " --profile " + run::shell_word(options.profile);
  if (!options.vectors.empty()) command += " --vectors " + run::shell_word(options.vectors);
  return command + " --filter ";
}

/// What today's judgement says that the recorded one did not.
struct News {
  std::vector<std::string> changed, not_judged;
  std::size_t not_executed = 0;
};

/// Was never sent: there is nothing to judge again, and nothing to say about it.
bool not_executed(results::Verdict verdict) {
  return verdict == results::Verdict::skip || verdict == results::Verdict::blocked;
}

std::string list(const std::string& heading, const std::vector<std::string>& lines) {
  constexpr std::size_t most = 50;
  std::string text = fmt::format("{} ({})\n", heading, lines.size());
  for (std::size_t i = 0; i < std::min(lines.size(), most); ++i) text += "  " + lines[i] + '\n';
  if (lines.size() > most) text += fmt::format("  ... and {} more\n", lines.size() - most);
  return text;
}

News judge_all(const JudgeOptions& options, const JudgePlan& plan, run::RunReport& report,
               const harness::Protocols& protocols) {
  News news;
  bench::Rejudge rejudge(plan.vectors, plan.profile, protocols);
  bench::Waivers waivers(plan.waivers, run::timestamp().substr(0, 10),
                         plan.recorded.run.identity.firmware);
  for (const results::CaseResult* one : plan.selected) {
    if (one->id.starts_with(bench::set_up_result)) {  // no case: there is nothing to judge again
      if (!report.add(*one)) return news;
      continue;
    }
    auto [result, why_not] = rejudge.judge(*one);
    result.replay = replay_command(options) + "'" + result.id + "'";
    waivers.apply(result);
    const std::string label = text::case_label(result);
    if (!why_not.empty() && not_executed(result.verdict))
      ++news.not_executed;
    else if (!why_not.empty())
      news.not_judged.push_back(fmt::format("{}: {}", label, text::xml_line(why_not)));
    else if (result.verdict != one->verdict)
      news.changed.push_back(
          fmt::format("{}  {} -> {}  {}", label, results::to_string(one->verdict),
                      results::to_string(result.verdict), text::xml_line(result.message)));
    if (!report.add(result)) return news;
  }
  for (const results::CaseResult& result : waivers.superfluous(run::case_ids(plan.vectors)))
    report.add(result);
  return news;
}

}  // namespace

int judge_command(const JudgeOptions& options, const harness::Protocols& protocols) {
  const Result<JudgePlan> plan = make_judge_plan(options, protocols);
  if (!plan) return run::complain(plan.error().message, run::exit_code::usage);
  if (plan->selected.empty())
    return run::complain(
        fmt::format("no result in {} matches --filter '{}'", options.file, options.filter),
        run::exit_code::nothing);
  Result<run::ReportPaths> paths =
      run::make_report_paths(options.out, options.json, options.junit, options.html);
  if (!paths) return run::complain(paths.error().message, run::exit_code::trouble);
  std::error_code ignored;
  if (std::filesystem::equivalent(paths->front().second, options.file, ignored))
    return run::complain(
        fmt::format("the results would overwrite {}; name another folder with --out", options.file),
        run::exit_code::usage);
  Result<run::RunReport> report =
      run::RunReport::create(std::move(*paths), run::console_options(plan->gate, options.verbose));
  if (!report) return run::complain(report.error().message, run::exit_code::trouble);
  if (const Status begun = report->begin(info_of(options, *plan)); !begun)
    return run::complain(begun.error().message, run::exit_code::trouble);
  const News news = judge_all(options, *plan, *report, protocols);
  run::tell(list("\nverdicts that changed", news.changed));
  if (!news.not_judged.empty()) run::tell(list("\nnot judged again", news.not_judged));
  if (news.not_executed > 0)
    run::tell(fmt::format("\nnot executed when this was recorded: {} SKIP or BLOCKED\n",
                          news.not_executed));
  return report->finish({});
}

}  // namespace fieldproof::cli
