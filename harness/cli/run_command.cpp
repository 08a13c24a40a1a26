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
#include "harness/cli/line_steps.hpp"
#include "harness/cli/ports.hpp"
#include "harness/cli/run_plan.hpp"
#include "harness/cli/run_report.hpp"
#include "harness/cli/shared_run.hpp"
#include "harness/cli/soak_log.hpp"
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
      : options_(options), plan_(plan), ports_(ports), benches_(ports.front()), report_(report), lines_(plan, ports.front(), options.reconfigure) {}

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
    if (!plan_.matrix.empty()) info.properties["matrix"] = options_.matrix;
    if (plan_.soak > 0ns) info.properties["duration"] = options_.duration;
    if (!floors_.empty() && !floors_.front().empty()) info.properties["floor"] = floors_.front();
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

  /// Sanity exchange and floor of each device, which the head of the reports tells of; an error: nothing can run.
  Status start() {
    if (const Status measured = measure_over_loop(); !measured) return measured;
    if (!plan_.matrix.empty()) return ok();  // at each step
    for (Benches& port : ports_) {
      const Status alive = port.start();
      Result<std::string> floor = alive ? take_floor(port) : alive.error();
      if (!floor && (plan_.others.empty() || floor.error().interrupted)) return floor.error();
      floors_.push_back(floor ? *floor : "");
      unable_.push_back(floor ? "" : floor.error().message);  // the other devices go on without it
    }
    return ok();
  }

  /// Cases, sanity exchange; how it ended.
  RunReport::End execute(const Status& started) {
    started_ = std::chrono::steady_clock::now();
    if (started && !plan_.others.empty()) return share_out();
    if (started) {
      run_with_gtest(plan_.selected, runner_options(), [this](const Case& source, int round) { return run_case(source, round); });
      if (soak_ && report_.tally().total() > 0) report_.add(soak_->summary(seconds()));
      // Whoever vanished is trouble, whatever the verdict of the case in which it did. Steps of a matrix are BLOCKED.
      if (plan_.matrix.empty() && !interrupted() && end_.trouble.empty()) end_.trouble = benches_.stopped();
      // The last sanity exchange: whatever the cases left behind, the device still answers.
      if (!interrupted() && lines_.live())
        if (const Status still = benches_.start(); !still && !still.error().interrupted) end_.trouble = "after the last case: " + still.error().message;
      // Waivers that the whole run has shown to be needless turn the gate red.
      for (const CaseResult& result : waivers_.superfluous(case_ids(plan_.vectors))) report_.add(result);
    } else if (started.error().interrupted) {
      end_.interrupted = true;
    } else {
      end_.trouble = started.error().message;
    }
    put_back();
    return end_;
  }

 private:
  const DutPlan& dut(std::size_t port) const { return port == 0 ? plan_ : plan_.others[port - 1]; }

  double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - started_).count(); }

  /// With --loop: the floor of that link, for this one.
  Status measure_over_loop() {
    if (!plan_.loop) return ok();
    Result<Benches> loop = Benches::open(*plan_.loop, {plan_.protocols.front()}, plan_.bench);
    if (!loop) return fail("--loop: " + loop.error().message);
    if (const Status alive = loop->start(); !alive) return Error{"--loop: " + alive.error().message, alive.error().interrupted};
    Result<std::optional<AdapterFloor>> measured = loop->measured_floor();
    if (!measured) return measured.error();
    if (!*measured) return fail("--loop: simulated time has no floor; name a link on real time, such as pty:xbc-h");
    plan_.floor = std::move(**measured);
    plan_.floor->source = AdapterFloor::Source::loop;
    return ok();
  }

  Result<std::string> take_floor(Benches& benches) const {
    if (plan_.floor) return benches.use_floor(*plan_.floor);
    return benches.measure_floor();
  }

  /// How many results there will be; of a soak, at the speed so far.
  std::size_t expected_results() const {
    const std::size_t done = report_.tally().total();
    if (plan_.soak > 0ns) return done + static_cast<std::size_t>(static_cast<double>(done) * std::max(0.0, std::chrono::duration<double>(plan_.soak).count() / std::max(seconds(), 0.001) - 1));
    return plan_.selected.size() * static_cast<std::size_t>(options_.repeat) * std::max<std::size_t>(1, plan_.matrix.size());
  }

  /// The step of the line matrix to which this round belongs. False: stop here.
  bool enter_step(std::size_t step) {
    if (lines_.current() == step) return true;
    const Status entered = lines_.enter(step, [this](Benches& benches) { return take_floor(benches); });
    if (!entered && entered.error().interrupted) end_.interrupted = true;
    else if (!entered) end_.trouble = entered.error().message;
    else report_.say(lines_.remark());
    return bool(entered);
  }

  /// A soak goes on as long as there is time, and something to talk to.
  bool soak_goes_on(int round) {
    if (!soak_) soak_.emplace(std::chrono::duration<double>(plan_.soak).count(), report_.gate());
    if (!benches_.stopped().empty()) end_.trouble = benches_.stopped();
    return end_.trouble.empty() && !soak_->over(seconds()) && !soak_->idle(round);
  }

  bool add_to_soak(const CaseResult& result) {
    if (!report_.add(result, soak_->take(result, seconds()))) return false;
    const std::optional<SoakSample> sample = soak_->due_sample(seconds());
    return !sample || report_.add(*sample);
  }

  RunnerOptions runner_options() const {
    const int steps = std::max<int>(1, static_cast<int>(plan_.matrix.size()));
    return {plan_.soak > 0ns ? -1 : options_.repeat * steps, options_.seed >= 0, std::max(0, options_.seed), options_.gtest_arguments};
  }

  /// The same on several ports at once. GoogleTest settles which cases, and in which order they are taken.
  RunReport::End share_out() {
    std::deque<SharedRun::Task> tasks;
    run_with_gtest(plan_.selected, runner_options(), [&](const Case& source, int repeat) {
      tasks.push_back({&source, repeat});
      return true;
    });
    const std::size_t total = tasks.size();
    std::vector<SharedRun::Port> ports;
    for (std::size_t i = 0; i < ports_.size(); ++i) ports.push_back({dut(i).identity.name, &ports_[i], unable_[i]});
    SharedRun shared(std::move(ports), std::move(tasks), [&](const Case& source, CaseResult result) {
      report_.show_progress(total, source.id);
      waivers_.apply(result);
      return report_.add(result) && !(options_.fail_fast && gates(result.verdict, report_.gate()));
    });
    shared.execute();
    for (const CaseResult& result : waivers_.superfluous(case_ids(plan_.vectors))) report_.add(result);
    end_.interrupted = shared.interrupted();
    end_.trouble = fmt::format("{}", fmt::join(shared.troubles(), "; "));
    put_back();
    return end_;
  }

  /// What the devices have in common stays in `info`, each has an entry of its own.
  void name_devices(RunInfo& info) const {
    for (std::size_t i = 0; i < ports_.size(); ++i) {
      const DutPlan& plan = dut(i);
      DutInfo one{ports_[i].describe(), {{"station", std::to_string(plan.bench.station)}}, plan.identity};
      if (!plan.line.empty()) one.properties["line"] = plan.line;
      if (i < floors_.size() && !floors_[i].empty()) one.properties["floor"] = floors_[i];
      info.duts.push_back(std::move(one));
    }
    for (std::size_t i = 1; i < info.duts.size(); ++i) {
      info.identity = in_common(info.identity, info.duts[i].identity);
      info.endpoint += ", " + info.duts[i].endpoint;
    }
    info.properties.erase("station");
    info.properties.erase("line");
    info.properties.erase("floor");
  }

  /// Tells shards of one selection from those of another.
  std::string selection() const {
    std::uint64_t print = empty_fingerprint;
    for (const Case* one : plan_.selected) print = extend_fingerprint(print, one->id + '\n');
    return fmt::format("{} cases, {:016x}", plan_.selected.size(), print);
  }

  /// False: stop here.
  bool run_case(const Case& source, int round) {
    if (interrupted()) {
      end_.interrupted = true;
      return false;
    }
    const bool matrix = !plan_.matrix.empty(), soak = plan_.soak > 0ns;
    if (matrix && !enter_step(static_cast<std::size_t>(round / options_.repeat))) return false;
    if (soak && !soak_goes_on(round)) return false;
    report_.show_progress(expected_results(), source.id);
    const auto started = std::chrono::steady_clock::now();
    watchdog_.watch(source.id);
    CaseResult result = matrix ? lines_.run(source) : benches_.run(source);
    const bool hung = watchdog_.done();
    if (benches_.interrupted() && !hung) {
      end_.interrupted = true;  // the case was not finished: it has no result
      return false;
    }
    if (hung) result.message = "the bench hung in this case for more than a minute; " + result.message;
    waivers_.apply(result);
    result.repeat = soak ? round : round % options_.repeat;
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
    const bool stop_here = hung || (options_.fail_fast && gates(result.verdict, report_.gate()));
    return (soak ? add_to_soak(result) : report_.add(result)) && !stop_here;
  }

  /// What is still open in the journal; also after Ctrl-C, for which the device is none the worse.
  void put_back() {
    if (end_.interrupted) clear_interrupt();
    for (std::size_t i = 0; i < ports_.size(); ++i)
      if (const std::string open = ports_[i].put_back(); !open.empty())
        end_.not_restored += fmt::format("{}NOT RESTORED: {}; type: fieldproof restore {}", end_.not_restored.empty() ? "" : "\n", open, shell_word(dut(i).journal));
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
  LineSteps lines_;
  std::optional<SoakLog> soak_;
  std::vector<std::string> floors_;  // of each port: what the link can show, in words
  std::vector<std::string> unable_;  // of each port: why it cannot run; empty: it can
  std::chrono::steady_clock::time_point started_;
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
Status open_journal(const RunOptions& options, DutPlan& plan) {
  if (plan.journal.empty()) return ok();
  Result<Journal> journal = Journal::open(plan.journal);
  if (!journal) return journal.error();
  for (const JournalDevice& device : {plan.bench.device, plan.bench.aux_device}) {
    if (options.discard_journal)
      if (Status discarded = journal->discard(device); !discarded) return discarded;
    const auto open = std::ranges::count_if(journal->open_entries(), [&](const OpenEntry& one) { return is_same_device(one.device, device); });
    if (open > 0)
      return fail(fmt::format("cannot write to {}: an earlier run was cut off before it had put back {} of its values; type: fieldproof restore {}\n"
                              "(or forget them: --discard-journal)", device.endpoint, open, shell_word(plan.journal)));
  }
  plan.bench.journal = std::make_shared<Journal>(std::move(*journal));
  return ok();
}

Status open_journals(const RunOptions& options, RunPlan& plan) {
  Status opened = open_journal(options, plan);
  for (std::size_t i = 0; i < plan.others.size() && opened; ++i) opened = open_journal(options, plan.others[i]);
  return opened;
}

int execute(const RunOptions& options, RunPlan& plan, std::vector<Benches>& ports, const std::optional<RunSummary>& baseline) {
  Result<ReportPaths> paths = make_report_paths(options.out, options.json, options.junit, options.html);
  if (!paths) return complain(paths.error().message, exit_code::trouble);
  if (!options.capture.empty()) paths->emplace_back("capture", options.capture);
  Result<RunReport> report = RunReport::create(std::move(*paths), console_options(gate_of(options), options.verbose));
  if (!report) return complain(report.error().message, exit_code::trouble);
  const Status same_devices = plan.matrix.empty() ? take_fingerprints(plan, ports, options.qualify) : ok();
  Run run(options, plan, ports, *report);
  const Status started = same_devices ? run.start() : same_devices;
  if (const Status begun = report->begin(run.info()); !begun) return complain(begun.error().message, exit_code::trouble);
  RunReport::End end = run.execute(started);
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
    return complain(fmt::format("no case{} matches --filter '{}'; `fieldproof list` shows them all", options.role.empty() ? "" : " of --role " + options.role, options.filter), exit_code::nothing);
  if (options.dry_run) return dry_run(*plan);
  const Result<std::optional<RunSummary>> baseline = load_baseline(options, *plan);
  if (!baseline) return complain(baseline.error().message, exit_code::usage);
  catch_interrupts();
  const auto trouble = [&](const Error& error) { return complain(error.message, options.skip_absent && error.absent ? exit_code::absent : exit_code::trouble); };
  if (const Status opened = open_journals(options, *plan); !opened) return complain(opened.error().message, exit_code::usage);
  const Result<std::vector<Fixtures>> fixtures = open_fixtures(*plan);
  if (!fixtures) return trouble(fixtures.error());
  Result<std::vector<Benches>> ports = open_ports(*plan);
  if (!ports) return trouble(ports.error());
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
