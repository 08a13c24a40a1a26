#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fmt/format.h>
#include <optional>
#include <set>

#include "harness/bench/benches.hpp"
#include "harness/bench/runner.hpp"
#include "harness/bench/watchdog.hpp"
#include "harness/cli/commands.hpp"
#include "harness/cli/compare_command.hpp"
#include "harness/cli/run_plan.hpp"
#include "harness/cli/run_report.hpp"
#include "harness/cli/timestamp.hpp"
#include "harness/cli/tool_vectors.hpp"
#include "harness/endpoints/interrupt.hpp"
#include "harness/results/ndjson.hpp"

namespace fieldproof {

namespace {

Gate gate_of(const RunOptions& options) { return {options.strict, options.fail_on_marginal, options.qualify}; }

/// The run itself: cases to results.
class Run {
 public:
  Run(const RunOptions& options, RunPlan& plan, Benches& benches, RunReport& report)
      : options_(options), plan_(plan), benches_(benches), report_(report) {}

  RunInfo info() const {
    RunInfo info;
    info.tool_version = FIELDPROOF_VERSION;
    info.started = timestamp();
    info.endpoint = benches_.describe();
    info.profile = plan_.bench.profile.name;
    info.command = options_.command;
    info.vectors_hash = plan_.vectors.hash;
    info.properties["gate"] = to_string(gate_of(options_));
    info.properties["station"] = std::to_string(plan_.bench.station);
    info.properties["protocol"] = benches_.protocol_names();
    if (!plan_.bench.profile.title.empty()) info.properties["device"] = plan_.bench.profile.title;
    if (options_.seed >= 0) info.properties["seed"] = std::to_string(options_.seed);
    if (options_.repeat > 1) info.properties["repeat"] = std::to_string(options_.repeat);
    if (!plan_.line.empty()) info.properties["line"] = plan_.line;
    info.properties["response_max_ms"] = fmt::format("{:g}", to_ms(plan_.bench.profile.response_max));
    info.identity = plan_.identity;
    info.hashes = plan_.hashes;
    info.errata = errata();
    return info;
  }

  /// Sanity exchange, cases, sanity exchange; how it ended.
  RunReport::End execute() {
    if (const Status alive = benches_.start(); alive) {
      RunnerOptions runner{options_.repeat, options_.seed >= 0, std::max(0, options_.seed), options_.gtest_arguments};
      run_with_gtest(plan_.selected, runner, [this](const Case& source, int repeat) { return run_case(source, repeat); });
      // The last sanity exchange: whatever the cases left behind, the device still answers.
      if (!interrupted())
        if (const Status still = benches_.start(); !still && !still.error().interrupted) end_.trouble = "after the last case: " + still.error().message;
      // Waivers that the whole run has shown to be needless turn the gate red.
      for (const CaseResult& result : waivers_.superfluous(case_ids(plan_.vectors))) report_.add(result);
    } else if (alive.error().interrupted) {
      end_.interrupted = true;
    } else {
      end_.trouble = alive.error().message;
    }
    put_back();
    return end_;
  }

 private:
  /// False: stop here.
  bool run_case(const Case& source, int repeat) {
    if (interrupted()) {
      end_.interrupted = true;
      return false;
    }
    report_.show_progress(plan_.selected.size() * static_cast<std::size_t>(options_.repeat), source.id);
    const auto started = std::chrono::steady_clock::now();
    watchdog_.watch(source.id);
    CaseResult result = benches_.run(source);
    const bool hung = watchdog_.done();
    if (benches_.interrupted() && !hung) {
      end_.interrupted = true;  // the case was not finished: it has no result
      return false;
    }
    if (hung) result.message = "the bench hung in this case for more than a minute; " + result.message;
    waivers_.apply(result);
    result.repeat = repeat;
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
    const bool stop_here = hung || (options_.fail_fast && gates(result.verdict, report_.gate()));
    return report_.add(result) && !stop_here;
  }

  /// What is still open in the journal; also after Ctrl-C, for which the device is none the worse.
  void put_back() {
    if (end_.interrupted) clear_interrupt();
    const std::string open = benches_.put_back();
    if (!open.empty()) end_.not_restored = fmt::format("NOT RESTORED: {}; type: fieldproof restore {}", open, shell_word(plan_.journal));
  }

  /// The mistakes of the manuals that the selected cases met.
  std::vector<ErratumInfo> errata() const {
    std::set<std::string> selected;
    for (const Case* one : plan_.selected) selected.insert(one->vector_id);
    std::vector<ErratumInfo> met;
    for (const Erratum& one : plan_.vectors.errata)
      if (selected.contains(one.vector_id)) met.push_back(erratum_info(one));
    return met;
  }

  const RunOptions& options_;
  RunPlan& plan_;
  Benches& benches_;
  RunReport& report_;
  Watchdog watchdog_;
  Waivers waivers_{plan_.waivers, timestamp().substr(0, 10), plan_.identity.firmware};
  RunReport::End end_;
};

int dry_run(const RunPlan& plan) {
  for (const Case* one : plan.selected) fmt::print("{:<58} {}\n", one->id, one->title);
  fmt::print("{} cases would run on {}:{}\n", plan.selected.size(), plan.endpoint.kind, plan.endpoint.target);
  return exit_code::ok;
}

/// The results of this run against those of an earlier one, as far as it has the selected cases; was anything better then?
bool worse_than(const RunSummary& baseline, const RunOptions& options, RunReport& report) {
  const Result<ResultFile> now = read_result_file(report.paths().front().second);
  if (!now) return complain(now.error().message, 0), false;
  const ComparisonSet set({baseline, summarize(*now)});
  const std::filesystem::path out = options.out;
  const std::string html = (out / "compare.html").string(), junit = (out / "compare.xml").string();
  if (const Status reported = report_comparison(set, html, junit); !reported) complain(reported.error().message, 0);
  report.add_path("compare", html);
  report.add_path("compare", junit);
  return set.worse();
}

/// The baseline's results of the selected cases.
Result<std::optional<RunSummary>> load_baseline(const RunOptions& options, const RunPlan& plan) {
  if (options.baseline.empty()) return std::optional<RunSummary>();
  Result<ResultFile> file = read_result_file(options.baseline);
  if (!file) return file.error();
  std::set<std::string> selected;
  for (const Case* one : plan.selected) selected.insert(one->id);
  std::erase_if(file->results, [&](const CaseResult& one) { return !selected.contains(one.id); });
  return std::optional(summarize(*file));
}

/// Opens the journal of a device that may be written. The error says what an earlier run left, and what to type.
Status open_journal(const RunOptions& options, RunPlan& plan) {
  if (plan.journal.empty()) return ok();
  Result<Journal> journal = Journal::open(plan.journal);
  if (!journal) return journal.error();
  if (options.discard_journal)
    if (Status discarded = journal->discard(plan.bench.device); !discarded) return discarded;
  const auto open = std::ranges::count_if(journal->open_entries(), [&](const OpenEntry& one) { return is_same_device(one.device, plan.bench.device); });
  if (open > 0)
    return fail(fmt::format("cannot write to {}: an earlier run was cut off before it had put back {} of its values; type: fieldproof restore {}\n"
                            "(or forget them: --discard-journal)", plan.bench.device.endpoint, open, shell_word(plan.journal)));
  plan.bench.journal = std::make_shared<Journal>(std::move(*journal));
  return ok();
}

int execute(const RunOptions& options, RunPlan& plan, Benches& benches, const std::optional<RunSummary>& baseline) {
  Result<ReportPaths> paths = make_report_paths(options.out, options.json, options.junit, options.html);
  if (!paths) return complain(paths.error().message, exit_code::trouble);
  if (!options.capture.empty()) paths->emplace_back("capture", options.capture);
  Result<RunReport> report = RunReport::create(std::move(*paths), console_options(gate_of(options), options.verbose));
  if (!report) return complain(report.error().message, exit_code::trouble);
  Run run(options, plan, benches, *report);
  if (const Status begun = report->begin(run.info()); !begun) return complain(begun.error().message, exit_code::trouble);
  RunReport::End end = run.execute();
  if (baseline) end.worse = worse_than(*baseline, options, *report);
  return report->finish(end);
}

}  // namespace

std::string shell_word(const std::string& word) {
  constexpr std::string_view plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=./,:@%";
  if (!word.empty() && word.find_first_not_of(plain) == std::string::npos) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

int complain(const std::string& message, int code) {
  fmt::print(stderr, "fieldproof: {}\n", message);
  return code;
}

int run_command(const RunOptions& options) {
  Result<RunPlan> plan = make_run_plan(options);
  if (!plan) return complain(plan.error().message, exit_code::usage);
  if (plan->selected.empty())
    return complain(fmt::format("no case matches --filter '{}'; `fieldproof list` shows them all", options.filter), exit_code::nothing);
  if (options.dry_run) return dry_run(*plan);
  const Result<std::optional<RunSummary>> baseline = load_baseline(options, *plan);
  if (!baseline) return complain(baseline.error().message, exit_code::usage);
  catch_interrupts();
  if (const Status opened = open_journal(options, *plan); !opened) return complain(opened.error().message, exit_code::usage);
  Result<Benches> benches = Benches::open(plan->endpoint, plan->protocols, plan->bench);
  if (!benches) return complain(benches.error().message, options.skip_absent && benches.error().absent ? exit_code::absent : exit_code::trouble);
  return execute(options, *plan, *benches, *baseline);
}

int report_command(const ReportOptions& options) {
  ReportPaths reports{{"junit", options.junit}, {"json", options.json}, {"html", options.html}, {"capture", options.capture}};
  std::erase_if(reports, [](const auto& one) { return one.second.empty(); });
  if (reports.empty()) return complain("nothing to write; give --junit FILE, --json FILE, --html FILE, --capture FILE or several", exit_code::usage);
  const Result<RunLog> log = read_ndjson(options.ndjson, [](const CaseResult&) {});
  if (!log) return complain(log.error().message, exit_code::usage);
  const auto gate = log->run.properties.find("gate");
  return derive_reports(options.ndjson, reports, gate == log->run.properties.end() ? Gate{} : parse_gate(gate->second));
}

}  // namespace fieldproof
