#include <fmt/format.h>
#include <algorithm>

#include "harness/bench/rejudge.hpp"
#include "harness/bench/waivers.hpp"
#include "harness/cli/commands.hpp"
#include "harness/paths.hpp"
#include "harness/run/run_report.hpp"
#include "harness/run/timestamp.hpp"
#include "harness/run/tool_vectors.hpp"
#include "reports/compare/result_file.hpp"
#include "reports/text/case_text.hpp"
#include "reports/text/xml_text.hpp"

namespace fieldproof {

namespace {

/// Everything that is settled before the first case is judged.
struct JudgePlan {
  ResultFile recorded;
  std::vector<const CaseResult*> selected;  // into `recorded`
  VectorSet vectors;
  Profile profile;
  std::vector<Waiver> waivers;
  Gate gate;
};

/// As the run was judged, and stricter where an option says so.
Gate gate_of(const JudgeOptions& options, const RunInfo& run) {
  const auto recorded = run.properties.find("gate");
  Gate gate = recorded == run.properties.end() ? Gate{} : parse_gate(recorded->second);
  gate.strict |= options.strict;
  gate.qualify |= options.qualify;
  gate.fail_on_marginal |= options.fail_on_marginal;
  return gate;
}

Result<JudgePlan> make_judge_plan(const JudgeOptions& options) {
  JudgePlan plan;
  Result<ResultFile> recorded = read_result_file(options.file);
  if (!recorded) return recorded.error();
  plan.recorded = std::move(*recorded);
  const std::string profile_name =
      options.profile.empty() ? plan.recorded.run.profile : options.profile;
  Result<Profile> profile = load_profile(profile_name, find_data().profiles);
  if (!profile)
    return fail(fmt::format(
        "cannot judge {} by the profile it was recorded with: {}; name one with --profile",
        options.file, profile.error().message));
  plan.profile = std::move(*profile);
  Result<VectorSet> vectors = load_sound_vectors(options.vectors);
  if (!vectors) return vectors.error();
  plan.vectors = std::move(*vectors);
  Result<std::vector<Waiver>> waivers = load_waivers(options.waivers);
  if (!waivers) return waivers.error();
  plan.waivers = std::move(*waivers);
  // What a run said about its waivers is said anew.
  for (const CaseResult& one : plan.recorded.results)
    if (!one.id.starts_with(waiver_result) && matches_filter(one.id, options.filter))
      plan.selected.push_back(&one);
  plan.gate = gate_of(options, plan.recorded.run);
  return plan;
}

/// The recorded run as it is judged today.
RunInfo info_of(const JudgeOptions& options, const JudgePlan& plan) {
  RunInfo info = plan.recorded.run;
  info.properties["recorded_in"] = options.file;
  info.properties["recorded_by"] = info.tool_version;
  info.properties["recorded_vectors"] = info.vectors_hash;
  info.properties["judged"] = timestamp();
  info.properties["gate"] = to_string(plan.gate);
  info.tool_version = FIELDPROOF_VERSION;
  info.profile = plan.profile.name;
  info.command = options.command;
  info.vectors_hash = plan.vectors.hash;
  return info;
}

std::string replay_command(const JudgeOptions& options) {
  std::string command = "fieldproof judge " + shell_word(options.file);
  if (!options.profile.empty()) command += " --profile " + shell_word(options.profile);
  if (!options.vectors.empty()) command += " --vectors " + shell_word(options.vectors);
  return command + " --filter ";
}

/// What today's judgement says that the recorded one did not.
struct News {
  std::vector<std::string> changed, not_judged;
  std::size_t not_executed = 0;
};

/// Was never sent: there is nothing to judge again, and nothing to say about it.
bool not_executed(Verdict verdict) {
  return verdict == Verdict::skip || verdict == Verdict::blocked;
}

std::string list(const std::string& heading, const std::vector<std::string>& lines) {
  constexpr std::size_t most = 50;
  std::string text = fmt::format("{} ({})\n", heading, lines.size());
  for (std::size_t i = 0; i < std::min(lines.size(), most); ++i) text += "  " + lines[i] + '\n';
  if (lines.size() > most) text += fmt::format("  ... and {} more\n", lines.size() - most);
  return text;
}

News judge_all(const JudgeOptions& options, const JudgePlan& plan, RunReport& report,
               const Protocols& protocols) {
  News news;
  Rejudge rejudge(plan.vectors, plan.profile, protocols);
  Waivers waivers(plan.waivers, timestamp().substr(0, 10), plan.recorded.run.identity.firmware);
  for (const CaseResult* one : plan.selected) {
    auto [result, why_not] = rejudge.judge(*one);
    result.replay = replay_command(options) + "'" + result.id + "'";
    waivers.apply(result);
    const std::string label = case_label(result);
    if (!why_not.empty() && not_executed(result.verdict))
      ++news.not_executed;
    else if (!why_not.empty())
      news.not_judged.push_back(fmt::format("{}: {}", label, xml_line(why_not)));
    else if (result.verdict != one->verdict)
      news.changed.push_back(fmt::format("{}  {} -> {}  {}", label, to_string(one->verdict),
                                         to_string(result.verdict), xml_line(result.message)));
    if (!report.add(result)) return news;
  }
  for (const CaseResult& result : waivers.superfluous(case_ids(plan.vectors))) report.add(result);
  return news;
}

}  // namespace

int judge_command(const JudgeOptions& options, const Protocols& protocols) {
  const Result<JudgePlan> plan = make_judge_plan(options);
  if (!plan) return complain(plan.error().message, exit_code::usage);
  if (plan->selected.empty())
    return complain(
        fmt::format("no result in {} matches --filter '{}'", options.file, options.filter),
        exit_code::nothing);
  Result<ReportPaths> paths =
      make_report_paths(options.out, options.json, options.junit, options.html);
  if (!paths) return complain(paths.error().message, exit_code::trouble);
  std::error_code ignored;
  if (std::filesystem::equivalent(paths->front().second, options.file, ignored))
    return complain(
        fmt::format("the results would overwrite {}; name another folder with --out", options.file),
        exit_code::usage);
  Result<RunReport> report =
      RunReport::create(std::move(*paths), console_options(plan->gate, options.verbose));
  if (!report) return complain(report.error().message, exit_code::trouble);
  if (const Status begun = report->begin(info_of(options, *plan)); !begun)
    return complain(begun.error().message, exit_code::trouble);
  const News news = judge_all(options, *plan, *report, protocols);
  print(list("\nverdicts that changed", news.changed));
  if (!news.not_judged.empty()) print(list("\nnot judged again", news.not_judged));
  if (news.not_executed > 0)
    print(fmt::format("\nnot executed when this was recorded: {} SKIP or BLOCKED\n",
                      news.not_executed));
  return report->finish({});
}

}  // namespace fieldproof
