#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>
#include <algorithm>
#include <chrono>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <set>

#include "harness/bench/benches.hpp"
#include "harness/bench/runner.hpp"
#include "harness/bench/watchdog.hpp"
#include "harness/cli/case_lines.hpp"
#include "harness/cli/commands.hpp"
#include "harness/cli/last_run.hpp"
#include "harness/cli/run_baseline.hpp"
#include "harness/judge/judge.hpp"
#include "harness/run/case_length.hpp"
#include "harness/run/coverage_hint.hpp"
#include "harness/run/line_steps.hpp"
#include "harness/run/long_texts.hpp"
#include "harness/run/look_on.hpp"
#include "harness/run/port_wait.hpp"
#include "harness/run/ports.hpp"
#include "harness/run/run_ahead.hpp"
#include "harness/run/run_info.hpp"
#include "harness/run/run_plan.hpp"
#include "harness/run/run_report.hpp"
#include "harness/run/shared_run.hpp"
#include "harness/run/soak_log.hpp"
#include "harness/run/timestamp.hpp"
#include "harness/run/tool_vectors.hpp"
#include "harness/system/interrupt.hpp"
#include "harness/system/terminal.hpp"
#include "reports/results/ndjson.hpp"

namespace fieldproof::cli {

using bench::Benches;
using compare::RunSummary;
using results::CaseResult;
using run::RunAhead;
using run::RunOptions;
using run::RunPlan;
using run::RunReport;
using vectors::Case;

namespace {

/// The run itself: cases to results.
class Run {
 public:
  /// One of `ports` for each device of the plan.
  Run(const RunOptions& options, RunPlan& plan, std::vector<Benches>& ports, RunReport& report)
      : options_(options),
        plan_(plan),
        ports_(ports),
        benches_(ports.front()),
        report_(report),
        lines_(plan, ports.front(), options.reconfigure) {}

  results::RunInfo info() const { return run::run_info(options_, plan_, ports_, floors_); }

  /// Sanity exchange and floor of each device, which the head of the reports tells of; an error:
  /// nothing can run.
  Status start() {
    if (const Status measured = measure_over_loop(); !measured) return measured;
    if (!plan_.matrix.empty()) return ok();  // at each step
    for (std::size_t i = 0; i < ports_.size(); ++i) {
      Benches& port = ports_[i];
      const Status alive = port.start();
      Result<std::string> floor =
          alive ? take_floor(port) : run::looked_on(alive.error(), port, plan_.dut(i));
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
    if (started && !go_ahead()) {
      finish_up();
      return end_;
    }
    if (started) {
      bench::run_with_gtest(
          plan_.selected, runner_options(),
          [this](const Case& source, int round) { return run_or_ask(source, round); });
      if (ahead_ && !stopped_) ahead_->finish(taker());
      if (soak_ && report_.tally().total() > 0) report_.add(soak_->summary(seconds()));
      // Whoever vanished is trouble, whatever the verdict of the case in which it did. Steps of a
      // matrix are BLOCKED.
      if (plan_.matrix.empty() && !os::interrupted() && end_.trouble.empty())
        end_.trouble = benches_.stopped();
      // The last sanity exchange: whatever the cases left behind, the device still answers.
      if (!os::interrupted() && lines_.live())
        if (const Status still = benches_.still_answers(); !still && !still.error().interrupted)
          end_.trouble = "after the last case: " + still.error().message;
      report_set_up();
      // Waivers that the whole run has shown to be needless turn the gate red.
      for (const CaseResult& result : waivers_.superfluous(run::case_ids(plan_.vectors)))
        report_.add(result);
    } else if (started.error().interrupted) {
      end_.interrupted = true;
    } else {
      end_.trouble = started.error().message;
    }
    finish_up();
    return end_;
  }

 private:
  double seconds() const { return since(started_); }

  static double since(std::chrono::steady_clock::time_point started) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
  }

  /// Cases on simulated time run in threads. False: they cannot.
  bool go_ahead() {
    if (!benches_.simulated()) return true;
    Result<std::vector<Benches>> more =
        run::open_more(plan_, plan_.selected.size() * static_cast<std::size_t>(options_.repeat));
    if (!more) end_.trouble = more.error().message;
    if (!more || more->empty()) return bool(more);
    more_ = std::move(*more);
    std::vector<RunAhead::Runner> runners;
    for (Benches& one : more_)
      runners.push_back([&one](const Case& source) {
        const auto started = std::chrono::steady_clock::now();
        std::optional<CaseResult> result = one.run_ahead(source);
        if (result) result->seconds = since(started);
        return result;
      });
    ahead_.emplace(std::move(runners));
    return true;
  }

  /// With --loop: the floor of that link, for this one.
  Status measure_over_loop() {
    if (!plan_.loop) return ok();
    Result<Benches> loop = Benches::open(*plan_.loop, {plan_.protocols.front()}, plan_.bench);
    if (!loop) return fail("--loop: " + loop.error().message);
    if (const Status alive = loop->start(); !alive)
      return Error{"--loop: " + alive.error().message, alive.error().interrupted};
    Result<std::optional<bench::AdapterFloor>> measured = loop->measured_floor();
    if (!measured) return measured.error();
    if (!*measured) return fail("--loop: simulated time has no floor; name a link on real time");
    plan_.floor = std::move(**measured);
    plan_.floor->source = bench::AdapterFloor::Source::loop;
    return ok();
  }

  Result<std::string> take_floor(Benches& benches) const {
    if (plan_.floor) return benches.use_floor(*plan_.floor);
    return benches.measure_floor();
  }

  /// How many results there will be; of a soak, at the speed so far.
  std::size_t expected_results() const {
    const std::size_t done = report_.tally().total();
    if (plan_.soak > 0ns)
      return done + static_cast<std::size_t>(
                        static_cast<double>(done) *
                        std::max(0.0, std::chrono::duration<double>(plan_.soak).count() /
                                              std::max(seconds(), 0.001) -
                                          1));
    return plan_.selected.size() * static_cast<std::size_t>(options_.repeat) *
           std::max<std::size_t>(1, plan_.matrix.size());
  }

  /// The step of the line matrix to which this round belongs. False: stop here.
  bool enter_step(std::size_t step) {
    if (lines_.current() == step) return true;
    const Status entered =
        lines_.enter(step, [this](Benches& benches) { return take_floor(benches); });
    if (!entered && entered.error().interrupted)
      end_.interrupted = true;
    else if (!entered)
      end_.trouble = entered.error().message;
    else
      report_.say(lines_.remark());
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
    const std::optional<results::SoakSample> sample = soak_->due_sample(seconds());
    return !sample || report_.add(*sample);
  }

  bench::RunnerOptions runner_options() const {
    const int steps = std::max<int>(1, static_cast<int>(plan_.matrix.size()));
    return {plan_.soak > 0ns ? -1 : options_.repeat * steps, options_.seed >= 0,
            std::max(0, options_.seed), options_.gtest_arguments};
  }

  /// The same on several ports at once. GoogleTest settles which cases, and in which order they are
  /// taken.
  RunReport::End share_out() {
    std::deque<run::SharedRun::Task> tasks;
    const std::map<const Case*, std::vector<std::size_t>> only = those_that_could_run();
    bench::run_with_gtest(plan_.selected, runner_options(), [&](const Case& source, int repeat) {
      tasks.push_back({&source, repeat, {}, only.at(&source)});
      return true;
    });
    if (options_.seed < 0) put_longest_first(tasks);
    const std::size_t total = tasks.size();
    std::vector<run::SharedRun::Port> ports;
    for (std::size_t i = 0; i < ports_.size(); ++i)
      ports.push_back({plan_.dut(i).identity.name, &ports_[i], unable_[i]});
    run::SharedRun shared(
        std::move(ports), std::move(tasks), [&](const Case& source, CaseResult result) {
          report_.show_progress(total, source.id);
          shorten_what_passed(source, result);
          settle(result);
          note(source, result);
          return report_.add(result) && !too_many_failures() &&
                 !(options_.fail_fast && results::gates(result.verdict, report_.gate()));
        });
    shared.execute();
    if (too_many_failures()) report_not_run(shared.left());
    report_set_up();
    for (const CaseResult& result : waivers_.superfluous(run::case_ids(plan_.vectors)))
      report_.add(result);
    end_.interrupted = shared.interrupted();
    end_.trouble = fmt::format("{}", fmt::join(shared.troubles(), "; "));
    finish_up();
    return end_;
  }

  /// The ports that could run each case; none where all can, or none.
  std::map<const Case*, std::vector<std::size_t>> those_that_could_run() const {
    std::map<const Case*, std::vector<std::size_t>> only;
    for (std::size_t port = 0; port < ports_.size(); ++port) {
      const std::vector<bool> could = ports_[port].could_each_run(plan_.selected);
      for (std::size_t i = 0; i < could.size(); ++i) {
        std::vector<std::size_t>& able = only[plan_.selected[i]];
        if (could[i]) able.push_back(port);
      }
    }
    for (auto& [source, able] : only)
      if (able.size() == ports_.size()) able.clear();
    return only;
  }

  /// So that all ports end at about the same time. Those of less than a second stay in their order.
  void put_longest_first(std::deque<run::SharedRun::Task>& tasks) const {
    const auto seconds = [&](const run::SharedRun::Task& task) {
      return run::least_length(*task.source, plan_.bench.profile.response_max) / 1s;
    };
    std::ranges::stable_sort(tasks, std::ranges::greater(), seconds);
  }

  /// On simulated time the cases are run by threads, and their results taken here, in order.
  bool run_or_ask(const Case& source, int round) {
    return ahead_ ? ahead_->ask(source, round, taker()) : take({&source, round});
  }

  RunAhead::Take taker() {
    return [this](RunAhead::Outcome outcome) { return take(std::move(outcome)); };
  }

  /// False: stop here. GoogleTest would swallow what is thrown, and the run would stay green.
  bool take(RunAhead::Outcome outcome) {
    const Case& source = *outcome.source;
    try {
      stopped_ = !run_one(source, outcome.round, std::move(outcome.result));
    } catch (const std::exception& error) {
      end_.trouble = run::internal_error(source, error);
      stopped_ = true;
    }
    return !stopped_;
  }

  bool too_many_failures() const {
    return options_.max_failures > 0 &&
           report_.tally().gating({options_.strict, options_.fail_on_marginal}) >=
               static_cast<std::size_t>(options_.max_failures);
  }

  CaseResult not_run(const Case& source) const {
    CaseResult result = judging::result_of(source);
    result.verdict = results::Verdict::blocked;
    result.message = fmt::format("not run: --max-failures {} was reached", options_.max_failures);
    return result;
  }

  void report_not_run(const std::deque<run::SharedRun::Task>& tasks) {
    for (const run::SharedRun::Task& task : tasks) {
      CaseResult result = not_run(*task.source);
      result.repeat = task.repeat;
      settle(result);
      report_.add(result);
    }
  }

  /// `ahead`: what a thread has made of it.
  bool run_one(const Case& source, int round, std::optional<CaseResult> ahead) {
    if (os::interrupted()) {
      end_.interrupted = true;
      return false;
    }
    const bool matrix = !plan_.matrix.empty(), soak = plan_.soak > 0ns;
    if (matrix && !enter_step(static_cast<std::size_t>(round / options_.repeat))) return false;
    if (soak && (too_many_failures() || !soak_goes_on(round))) return false;
    report_.show_progress(expected_results(), source.id);
    const auto started = std::chrono::steady_clock::now();
    watchdog_.watch(source.id);
    const bool enough = too_many_failures();
    const double took = ahead ? ahead->seconds : -1;
    CaseResult result = enough   ? not_run(source)
                        : matrix ? lines_.run(source)
                                 : benches_.conclude(source, std::move(ahead));
    const bool hung = watchdog_.done();
    if (benches_.interrupted() && !hung) {
      end_.interrupted = true;  // the case was not finished: it has no result
      return false;
    }
    if (hung)
      result.message = "the bench hung in this case for more than a minute; " + result.message;
    shorten_what_passed(source, result);
    settle(result);
    note(source, result);
    result.repeat = soak ? round : round % options_.repeat;
    result.seconds = took < 0 ? since(started) : took;
    const bool stop_here =
        hung || (options_.fail_fast && results::gates(result.verdict, report_.gate()));
    return (soak ? add_to_soak(result) : report_.add(result)) && !stop_here;
  }

  void finish_up() {
    put_back();
    for (const Error& one : plan_.missing)
      if (one.absent && options_.skip_absent)
        report_.say("left out (--skip-absent): " + one.message);
      else
        end_.trouble += (end_.trouble.empty() ? "" : "; ") + one.message;
    if (!blocked_.empty() && plan_.matrix.empty() && end_.trouble.empty() && !end_.interrupted)
      end_.hint = run::coverage_hint(benches_, plan_.bench, plan_.known,
                                     {blocked_.begin(), blocked_.end()});
  }

  void note(const Case& source, const CaseResult& result) {
    if (result.verdict == results::Verdict::blocked && !too_many_failures())
      blocked_.insert(&source);
  }

  void report_set_up() {
    for (const Benches& port : ports_)
      for (CaseResult& result : port.set_up_findings()) {
        settle(result);
        report_.add(result);
      }
  }

  /// What was made by rule has hundreds of frames.
  static void shorten_what_passed(const Case& source, CaseResult& result) {
    if (source.by_rule && !results::gates(result.verdict, {true, true}))
      run::LongTexts::shorten_exchange(result);
  }

  /// As it goes to the reports.
  void settle(CaseResult& result) {
    if (result.verdict == results::Verdict::blocked)
      for (const Error& one : plan_.missing)
        result.notes.push_back("not there to run it: " + one.message);
    waivers_.apply(result);
    long_texts_.shorten(result);
  }

  /// What is still open in the journal; also after Ctrl-C, for which the device is none the worse.
  void put_back() {
    if (end_.interrupted) os::clear_interrupt();
    const auto tell = [&](const std::string& text) {
      end_.not_restored += (end_.not_restored.empty() ? "" : "\n") + text;
    };
    for (std::size_t i = 0; i < ports_.size(); ++i) {
      if (const std::string open = ports_[i].put_back();
          !open.empty() && (!plan_.dut(i).ends_with_run || plan_.dut(i).aux))
        tell(run::not_restored(open, plan_.dut(i).journal));
      if (const std::string writes = ports_[i].doubtful_writes(); !writes.empty())
        tell(run::not_sure(writes));
    }
  }

  const RunOptions& options_;
  RunPlan& plan_;
  std::vector<Benches>& ports_;
  Benches& benches_;  // the first
  RunReport& report_;
  bench::Watchdog watchdog_;
  bench::Waivers waivers_{plan_.waivers, run::timestamp().substr(0, 10), plan_.identity.firmware};
  run::LineSteps lines_;
  std::vector<Benches> more_;      // of the threads, which `ahead_` ends first
  std::optional<RunAhead> ahead_;  // nothing: one case after another
  bool stopped_ = false;           // no further case is wanted
  std::optional<run::SoakLog> soak_;
  std::vector<std::string> floors_;  // of each port: what its link can show, in words
  std::vector<std::string> unable_;  // of each port: why it cannot run; empty: it can
  std::chrono::steady_clock::time_point started_;
  run::LongTexts long_texts_;
  std::set<const Case*> blocked_;
  RunReport::End end_;
};

int dry_run(const RunPlan& plan) {
  run::print(case_lines(plan.selected, os::terminal_columns(STDOUT_FILENO)));
  run::tell(fmt::format("{} cases would run on {}:{}\n", plan.selected.size(), plan.endpoint.kind,
                        plan.endpoint.target));
  return run::exit_code::ok;
}

int execute(const RunOptions& options, RunPlan& plan, std::vector<Benches>& ports,
            run::ReportPaths paths, std::optional<RunSummary> baseline) {
  Result<RunReport> report = RunReport::create(
      std::move(paths), run::console_options(run::gate_of(options), options.verbose));
  if (!report) return run::complain(report.error().message, run::exit_code::trouble);
  const Status same_devices =
      plan.matrix.empty() ? run::take_fingerprints(plan, ports, options.qualify) : ok();
  RunSummary now;
  now.path = report->path();
  Run run(options, plan, ports, *report);
  if (options.baseline == last_run) {
    Result<std::optional<RunSummary>> last =
        baseline_of_history(options, plan, run.info(), *report);
    if (!last) return run::complain(last.error().message, run::exit_code::usage);
    baseline = std::move(*last);
  }
  if (baseline || !options.history.empty()) report->attach(compare::summarizer(now));
  const Status started = same_devices ? run.start() : same_devices;
  if (const Status begun = report->begin(run.info()); !begun)
    return run::complain(begun.error().message, run::exit_code::trouble);
  RunReport::End end = run.execute(started);
  if (baseline) compare_with(*baseline, now, options, *report, end);
  add_to_history(options, std::move(now), *report, end);
  return report->finish(end);
}

}  // namespace

int run_command(const RunOptions& options, const harness::Protocols& protocols) {
  Result<RunPlan> plan = run::make_run_plan(options, protocols);
  if (!plan) return run::complain(plan.error().message, run::exit_code::usage);
  if (plan->selected.empty())
    return run::complain(
        fmt::format("no case{} matches --filter '{}'{}; `fieldproof list` shows them all",
                    options.role.empty() ? "" : " of --role " + options.role, options.filter,
                    run::meant_filter(options.vectors, protocols, options.filter)),
        run::exit_code::nothing);
  if (options.dry_run) return dry_run(*plan);
  Result<std::optional<RunSummary>> baseline = baseline_of_file(options, *plan);
  if (!baseline) return run::complain(baseline.error().message, run::exit_code::usage);
  if (const Status fit = check_history(options); !fit)
    return run::complain(fit.error().message, run::exit_code::usage);
  os::catch_interrupts();
  const auto trouble = [&](const Error& error) {
    return run::complain(error.message, error.interrupted ? run::exit_code::interrupted
                                        : options.skip_absent && error.absent
                                            ? run::exit_code::absent
                                            : run::exit_code::trouble);
  };
  Result<run::ReportPaths> paths =
      run::make_report_paths(options.out, options.json, options.junit, options.html);
  if (!paths) return run::complain(paths.error().message, run::exit_code::trouble);
  if (!options.capture.empty()) paths->emplace_back("capture", options.capture);
  if (!options.csv.empty()) paths->emplace_back("csv", options.csv);
  if (const Status free = run::await_ports(*plan); !free) return trouble(free.error());
  if (const Status opened = run::open_journals(options, *plan); !opened)
    return run::complain(opened.error().message, run::exit_code::usage);
  Result<run::Devices> devices = run::open_devices(*plan);
  if (!devices) return trouble(devices.error());
  plan->selected = devices->ports.front().grouped(plan->selected);
  return execute(options, *plan, devices->ports, std::move(*paths), std::move(*baseline));
}

int report_command(const ReportOptions& options) {
  run::ReportPaths reports{{"junit", options.junit},
                           {"json", options.json},
                           {"html", options.html},
                           {"capture", options.capture},
                           {"csv", options.csv}};
  std::erase_if(reports, [](const auto& one) { return one.second.empty(); });
  if (reports.empty())
    return run::complain(
        "nothing to write; give --junit FILE, --json FILE, --html FILE, --capture FILE, --csv "
        "FOLDER or several",
        run::exit_code::usage);
  results::Sinks sinks = run::sinks_for(reports);
  if (const auto log = results::replay(options.ndjson, sinks); !log)
    return run::complain(log.error().message, run::exit_code::usage);
  int code = run::exit_code::ok;
  for (const std::string& trouble : sinks.troubles())
    code = run::complain(trouble, run::exit_code::trouble);
  return code;
}

}  // namespace fieldproof::cli
