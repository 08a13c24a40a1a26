#include <algorithm>
#include <chrono>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <optional>
#include <set>

#include "harness/bench/benches.hpp"
#include "harness/bench/runner.hpp"
#include "harness/bench/watchdog.hpp"
#include "harness/cli/commands.hpp"
#include "harness/cli/compare_command.hpp"
#include "harness/cli/run_plan.hpp"
#include "harness/cli/run_report.hpp"
#include "harness/cli/shared_run.hpp"
#include "harness/cli/timestamp.hpp"
#include "harness/cli/tool_vectors.hpp"
#include "harness/endpoints/interrupt.hpp"
#include "harness/results/ndjson.hpp"
#include "harness/results/shard.hpp"
#include "harness/vectors/fingerprint.hpp"

namespace fieldproof {

namespace {

Gate gate_of(const RunOptions& options) { return {options.strict, options.fail_on_marginal, options.qualify}; }

/// The run itself: cases to results.
class Run {
 public:
  /// One of `ports` for each device of the plan.
  Run(const RunOptions& options, RunPlan& plan, std::vector<Benches>& ports, RunReport& report)
      : options_(options), plan_(plan), ports_(ports), benches_(ports.front()), report_(report) {}

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
    if (!plan_.bench.profile.notes.empty()) info.properties["profile_notes"] = plan_.bench.profile.notes;
    if (!plan_.bench.profile.title.empty()) info.properties["device"] = plan_.bench.profile.title;
    if (options_.seed >= 0) info.properties["seed"] = std::to_string(options_.seed);
    if (options_.repeat > 1) info.properties["repeat"] = std::to_string(options_.repeat);
    if (!plan_.line.empty()) info.properties["line"] = plan_.line;
    info.properties["response_max_ms"] = fmt::format("{:g}", to_ms(plan_.bench.profile.response_max));
    info.identity = plan_.identity;
    info.hashes = plan_.hashes;
    if (const std::optional<Shard> shard = shard_of_environment()) {
      info.properties["shard"] = to_string(*shard);
      info.properties["selection"] = selection();
    }
    info.errata = errata();
    if (!plan_.others.empty()) name_devices(info);
    return info;
  }

  /// Sanity exchange, cases, sanity exchange; how it ended.
  RunReport::End execute() {
    if (!plan_.others.empty()) return share_out();
    if (const Status alive = benches_.start(); alive) {
      run_with_gtest(plan_.selected, runner_options(), [this](const Case& source, int repeat) { return run_case(source, repeat); });
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
    return end_;
  }

 private:
  RunnerOptions runner_options() const { return {options_.repeat, options_.seed >= 0, std::max(0, options_.seed), options_.gtest_arguments}; }

  /// The same on several ports at once. GoogleTest settles which cases, and in which order they are taken.
  RunReport::End share_out() {
    std::deque<SharedRun::Task> tasks;
    run_with_gtest(plan_.selected, runner_options(), [&](const Case& source, int repeat) {
      tasks.push_back({&source, repeat});
      return true;
    });
    const std::size_t total = tasks.size();
    std::vector<SharedRun::Port> ports{{plan_.identity.name, &ports_.front()}};
    for (std::size_t i = 0; i < plan_.others.size(); ++i) ports.push_back({plan_.others[i].identity.name, &ports_[i + 1]});
    SharedRun shared(std::move(ports), std::move(tasks), [&](const Case& source, CaseResult result) {
      report_.show_progress(total, source.id);
      waivers_.apply(result);
      return report_.add(result) && !(options_.fail_fast && gates(result.verdict, report_.gate()));
    });
    shared.execute();
    for (const CaseResult& result : waivers_.superfluous(case_ids(plan_.vectors))) report_.add(result);
    end_.interrupted = shared.interrupted();
    end_.trouble = fmt::format("{}", fmt::join(shared.troubles(), "; "));
    return end_;
  }

  /// What the devices have in common stays in `info`, each has an entry of its own.
  void name_devices(RunInfo& info) const {
    const auto add = [&](const DutPlan& plan, const Benches& benches) {
      DutInfo dut{benches.describe(), {{"station", std::to_string(plan.bench.station)}}, plan.identity};
      if (!plan.line.empty()) dut.properties["line"] = plan.line;
      info.duts.push_back(std::move(dut));
    };
    add(plan_, ports_.front());
    for (std::size_t i = 0; i < plan_.others.size(); ++i) add(plan_.others[i], ports_[i + 1]);
    for (std::size_t i = 1; i < info.duts.size(); ++i) {
      info.identity = in_common(info.identity, info.duts[i].identity);
      info.endpoint += ", " + info.duts[i].endpoint;
    }
    info.properties.erase("station");
    info.properties.erase("line");
  }

  /// Tells shards of one selection from those of another.
  std::string selection() const {
    std::uint64_t print = empty_fingerprint;
    for (const Case* one : plan_.selected) print = extend_fingerprint(print, one->id + '\n');
    return fmt::format("{} cases, {:016x}", plan_.selected.size(), print);
  }

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
  std::vector<Benches>& ports_;
  Benches& benches_;  // the first
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

/// One port a device; the error is that of the first that cannot be opened.
Result<std::vector<Benches>> open_ports(const RunPlan& plan) {
  std::vector<Benches> ports;
  const auto open = [&](const DutPlan& dut) -> Status {
    Result<Benches> port = Benches::open(dut.endpoint, dut.protocols, dut.bench);
    if (!port) return port.error();
    ports.push_back(std::move(*port));
    return ok();
  };
  if (const Status opened = open(plan); !opened) return opened.error();
  for (const DutPlan& other : plan.others)
    if (const Status opened = open(other); !opened) return opened.error();
  return ports;
}

/// Another device on the desk than the bench file has? Also looked at for a sheet to sign, which then shows it.
Status take_fingerprint(DutPlan& dut, Benches& port, bool wanted) {
  const Fingerprint& declared = dut.identity.fingerprint;
  if (declared.empty() && !wanted) return ok();
  Result<Fingerprint> found = port.fingerprint();
  if (!found && declared.empty()) return ok();
  if (!found) return found.error();
  dut.identity.fingerprint_found = std::move(*found);
  const std::string difference = fingerprint_difference(declared, dut.identity.fingerprint_found);
  if (difference.empty()) return ok();
  return fail(fmt::format("this is not the device '{}' of the bench file: {}; connect that device, or take the fingerprint anew with "
                          "fieldproof probe ENDPOINT --fingerprint", dut.identity.name, difference));
}

Status take_fingerprints(RunPlan& plan, std::vector<Benches>& ports, bool wanted) {
  Status taken = take_fingerprint(plan, ports.front(), wanted);
  for (std::size_t i = 0; i < plan.others.size() && taken; ++i) taken = take_fingerprint(plan.others[i], ports[i + 1], wanted);
  return taken;
}

int execute(const RunOptions& options, RunPlan& plan, std::vector<Benches>& ports, const std::optional<RunSummary>& baseline) {
  Result<ReportPaths> paths = make_report_paths(options.out, options.json, options.junit, options.html);
  if (!paths) return complain(paths.error().message, exit_code::trouble);
  if (!options.capture.empty()) paths->emplace_back("capture", options.capture);
  Result<RunReport> report = RunReport::create(std::move(*paths), console_options(gate_of(options), options.verbose));
  if (!report) return complain(report.error().message, exit_code::trouble);
  const Status same_devices = take_fingerprints(plan, ports, options.qualify);
  Run run(options, plan, ports, *report);
  if (const Status begun = report->begin(run.info()); !begun) return complain(begun.error().message, exit_code::trouble);
  if (!same_devices) return report->finish({same_devices.error().interrupted ? "" : same_devices.error().message, same_devices.error().interrupted});
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
  Result<std::vector<Benches>> ports = open_ports(*plan);
  if (!ports) return complain(ports.error().message, options.skip_absent && ports.error().absent ? exit_code::absent : exit_code::trouble);
  return execute(options, *plan, *ports, *baseline);
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
