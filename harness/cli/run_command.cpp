#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <optional>
#include <sys/ioctl.h>
#include <unistd.h>

#include "harness/bench/bench.hpp"
#include "harness/bench/runner.hpp"
#include "harness/bench/watchdog.hpp"
#include "harness/cli/commands.hpp"
#include "harness/cli/paths.hpp"
#include "harness/endpoints/interrupt.hpp"
#include "harness/results/ndjson.hpp"
#include "harness/vectors/loader.hpp"
#include "reports/case_text.hpp"
#include "reports/console.hpp"
#include "reports/json_report.hpp"
#include "reports/junit.hpp"

namespace fieldproof {

namespace {

namespace fs = std::filesystem;

std::string timestamp() {
  const std::time_t now = std::time(nullptr);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%S%z", std::localtime(&now));
  std::string stamp(text);
  return stamp.insert(stamp.size() - 2, ":");  // ISO 8601 writes +01:00
}

Gate gate_of(const RunOptions& options) { return {options.strict, options.fail_on_marginal, options.qualify}; }

ConsoleOptions console_options(const RunOptions& options) {
  ConsoleOptions console;
  console.gate = gate_of(options);
  console.verbose = options.verbose;
  console.terminal = isatty(STDOUT_FILENO) != 0;
  console.colour = std::getenv("NO_COLOR") == nullptr;
  winsize size{};
  if (console.terminal && ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 20) console.width = size.ws_col;
  return console;
}

/// The model that an endpoint emulates is its profile; a real device has one of its own.
std::string profile_name(const RunOptions& options, const EndpointName& endpoint) {
  if (!options.profile.empty()) return options.profile;
  const bool emulated = endpoint.kind == "emulator" || endpoint.kind == "pty";
  if (emulated) return endpoint.target.empty() ? "emulator" : endpoint.target;
  complain("no --profile given: judged as xbc-h, whose every decision binds; a real module wants a profile of its own, such as xbc-dxxxh", 0);
  return "xbc-h";
}

/// Everything that is settled before a byte is sent.
struct Plan {
  EndpointName endpoint;
  const Protocol* protocol = nullptr;
  BenchOptions bench;
  VectorSet vectors;
  std::vector<const Case*> selected;
};

std::string replay_command(const RunOptions& options) {
  std::string command = "fieldproof run --endpoint " + shell_word(options.endpoint);
  if (!options.profile.empty()) command += " --profile " + shell_word(options.profile);
  if (!options.vectors.empty()) command += " --vectors " + shell_word(options.vectors);
  for (const std::string& range : options.allow_write) command += " --allow-write " + shell_word(range);
  return command + " --filter ";
}

Result<BenchOptions> bench_options(const RunOptions& options, const EndpointName& endpoint, const DataPaths& data) {
  BenchOptions bench;
  Result<Profile> profile = load_profile(profile_name(options, endpoint), data.profiles);
  if (!profile) return profile.error();
  bench.profile = std::move(*profile);
  if (options.floor_ms > 0) bench.profile.floor = Duration(static_cast<Duration::rep>(options.floor_ms * 1e6));
  for (const std::string& range : options.allow_write)
    if (Status allowed = bench.fence.allow(range); !allowed) return allowed.error();
  if (!options.waivers.empty()) {
    Result<std::vector<Waiver>> waivers = load_waivers(options.waivers);
    if (!waivers) return waivers.error();
    bench.waivers = std::move(*waivers);
  }
  nlohmann::json station{{"station", endpoint.option("station", "1")}};
  const std::optional<int> number = config_station(station, 1);
  if (!number) return fail(fmt::format("station '{}' is not a number from 0 to 255", endpoint.option("station", "1")));
  bench.station = *number;
  bench.today = timestamp().substr(0, 10);
  bench.power_cycle_command = options.power_cycle;
  bench.replay = replay_command(options);
  return bench;
}

Result<Plan> make_plan(const RunOptions& options) {
  Plan plan;
  const DataPaths data = find_data();
  Result<EndpointName> endpoint = parse_endpoint(options.endpoint);
  if (!endpoint) return endpoint.error();
  plan.endpoint = std::move(*endpoint);
  const std::string protocol = plan.endpoint.option("protocol", "xgt-cnet");
  plan.protocol = find_protocol(protocol);
  if (!plan.protocol) return fail(fmt::format("no protocol '{}' in the endpoint; there is {}", protocol, protocols().front()->name()));
  Result<BenchOptions> bench = bench_options(options, plan.endpoint, data);
  if (!bench) return bench.error();
  plan.bench = std::move(*bench);
  plan.vectors = load_vectors(options.vectors.empty() ? data.vectors : fs::path(options.vectors), data.vectors / "schema.json");
  if (!plan.vectors.problems.empty())
    return fail(fmt::format("{}\n{} in the vectors; nothing was sent. `fieldproof lint` shows them all", fmt::join(plan.vectors.problems, "\n"),
                            plan.vectors.problems.size() == 1 ? "1 problem" : fmt::format("{} problems", plan.vectors.problems.size())));
  std::vector<std::string> ids;
  for (const Case& one : plan.vectors.cases) {
    ids.push_back(one.id);
    if (matches_filter(one.id, options.filter)) plan.selected.push_back(&one);
  }
  if (const std::vector<std::string> lost = unmatched(plan.bench.waivers, ids); !lost.empty())
    return fail(fmt::format("waivers for unknown cases: {}; remove or correct them", fmt::join(lost, ", ")));
  return plan;
}

/// The run itself: cases to results, results to the NDJSON file and the console.
class Run {
 public:
  Run(const RunOptions& options, Plan& plan, Bench& bench, NdjsonWriter& writer)
      : options_(options), plan_(plan), bench_(bench), writer_(writer), console_(console_options(options)) {}

  RunInfo info(const Endpoint& endpoint) const {
    RunInfo info;
    info.tool_version = FIELDPROOF_VERSION;
    info.started = timestamp();
    info.endpoint = endpoint.describe();
    info.profile = plan_.bench.profile.name;
    info.command = options_.command;
    info.vectors_hash = plan_.vectors.hash;
    info.properties["gate"] = to_string(gate_of(options_));
    info.properties["station"] = std::to_string(plan_.bench.station);
    info.properties["protocol"] = plan_.protocol->name();
    if (!plan_.bench.profile.title.empty()) info.properties["device"] = plan_.bench.profile.title;
    if (options_.seed >= 0) info.properties["seed"] = std::to_string(options_.seed);
    if (options_.repeat > 1) info.properties["repeat"] = std::to_string(options_.repeat);
    return info;
  }

  /// False: stop here.
  bool run_case(const Case& source, int repeat) {
    if (interrupted()) {
      interrupted_ = true;
      return false;
    }
    show(progress_line(tally_.total(), plan_.selected.size() * static_cast<std::size_t>(options_.repeat), tally_, source.id, console_));
    const auto started = std::chrono::steady_clock::now();
    watchdog_.watch(source.id);
    CaseResult result = bench_.run(source);
    const bool hung = watchdog_.done();
    if (bench_.interrupted() && !hung) {
      interrupted_ = true;  // the case was not finished: it has no result
      return false;
    }
    if (hung) result.message = "the bench hung in this case for more than a minute; " + result.message;
    result.repeat = repeat;
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
    return report(result) && !hung;
  }

  int finish(const std::string& trouble, std::chrono::steady_clock::time_point started, const std::vector<std::pair<std::string, std::string>>& reports) {
    Summary summary;
    summary.tally = tally_;
    summary.end.finished = timestamp();
    summary.end.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
    summary.end.interrupted = interrupted_;
    summary.end.trouble = !trouble.empty() ? trouble : write_trouble_;
    summary.end.exit_code = code(!summary.end.trouble.empty());
    summary.red = red_;
    summary.reports = reports;
    show(erase_progress(console_));
    if (const Status written = writer_.write(summary.end); !written) complain(written.error().message, 0);
    summary_ = summary;
    return summary.end.exit_code;
  }

  void interrupt() { interrupted_ = true; }
  void print_summary() { show(run_summary(*summary_, console_)); }
  const ConsoleOptions& console() const { return console_; }

 private:
  bool report(const CaseResult& result) {
    tally_.add(result.verdict);
    const bool is_red = gates(result.verdict, console_.gate);
    if (is_red && red_.size() < 1000) red_.push_back(case_label(result));
    if (const std::string text = case_report(result, console_); !text.empty()) show(erase_progress(console_) + text);
    if (const Status written = writer_.write(result); !written) {
      write_trouble_ = written.error().message;
      return false;
    }
    return !(options_.fail_fast && is_red);
  }

  int code(bool in_trouble) const {
    if (interrupted_) return exit_code::interrupted;
    if (in_trouble) return exit_code::trouble;
    // GoogleTest deals the cases out to shards; one of them may get none.
    if (tally_.total() == 0 && std::getenv("GTEST_TOTAL_SHARDS")) return exit_code::ok;
    return gate_exit_code(tally_, console_.gate, false);
  }

  static void show(const std::string& text) {
    std::fwrite(text.data(), 1, text.size(), stdout);
    if (!text.empty()) std::fflush(stdout);
  }

  const RunOptions& options_;
  Plan& plan_;
  Bench& bench_;
  NdjsonWriter& writer_;
  ConsoleOptions console_;
  Watchdog watchdog_;
  Tally tally_;
  std::vector<std::string> red_;
  std::optional<Summary> summary_;
  std::string write_trouble_;
  bool interrupted_ = false;
};

int derive_reports(const std::string& ndjson, const std::vector<std::pair<std::string, std::string>>& reports, const Gate& gate) {
  int code = exit_code::ok;
  for (const auto& [kind, path] : reports) {
    if (kind == "results") continue;
    const Result<Tally> written = kind == "junit" ? write_junit(ndjson, path, gate) : write_json(ndjson, path);
    if (!written) code = complain(written.error().message, exit_code::trouble);
  }
  return code;
}

int dry_run(const Plan& plan) {
  for (const Case* one : plan.selected) fmt::print("{:<58} {}\n", one->id, one->title);
  fmt::print("{} cases would run on {}:{}\n", plan.selected.size(), plan.endpoint.kind, plan.endpoint.target);
  return exit_code::ok;
}

std::string out_path(const RunOptions& options, const std::string& given, const char* name) {
  return given.empty() ? (fs::path(options.out) / name).string() : given;
}

int execute(const RunOptions& options, Plan& plan, Endpoint& endpoint) {
  std::error_code failed;
  fs::create_directories(options.out, failed);
  if (failed) return complain(fmt::format("cannot make the folder {}: {}; name another with --out", options.out, failed.message()), exit_code::trouble);
  const std::string ndjson = out_path(options, "", "results.ndjson");
  Result<NdjsonWriter> writer = NdjsonWriter::create(ndjson);
  if (!writer) return complain(writer.error().message, exit_code::trouble);

  const std::vector<std::pair<std::string, std::string>> reports{
      {"results", ndjson}, {"json", out_path(options, options.json, "results.json")}, {"junit", out_path(options, options.junit, "junit.xml")}};
  const auto started = std::chrono::steady_clock::now();
  Bench bench(endpoint, *plan.protocol, plan.bench);
  Run run(options, plan, bench, *writer);
  const RunInfo info = run.info(endpoint);
  if (const Status written = writer->write(info); !written) return complain(written.error().message, exit_code::trouble);
  fmt::print("{}", run_head(info));

  std::string trouble;
  if (const Status alive = bench.start(); alive) {
    RunnerOptions runner{options.repeat, options.seed >= 0, std::max(0, options.seed), options.gtest_arguments};
    run_with_gtest(plan.selected, runner, [&run](const Case& source, int repeat) { return run.run_case(source, repeat); });
    // The last sanity exchange: whatever the cases left behind, the device still answers.
    if (bench.stopped().empty() && !interrupted())
      if (const Status still = bench.start(); !still && !still.error().interrupted) trouble = "after the last case: " + still.error().message;
  } else if (alive.error().interrupted) {
    run.interrupt();
  } else {
    trouble = alive.error().message;
  }
  int code = run.finish(trouble, started, reports);
  const int report_code = derive_reports(ndjson, reports, run.console().gate);
  if (!trouble.empty()) complain(trouble, 0);
  run.print_summary();
  return code == exit_code::ok || code == exit_code::nothing ? std::max(code, report_code) : code;
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
  Result<Plan> plan = make_plan(options);
  if (!plan) return complain(plan.error().message, exit_code::usage);
  if (plan->selected.empty())
    return complain(fmt::format("no case matches --filter '{}'; `fieldproof list` shows them all", options.filter), exit_code::nothing);
  if (options.dry_run) return dry_run(*plan);
  catch_interrupts();
  Result<std::unique_ptr<Endpoint>> endpoint = open_endpoint(plan->endpoint);
  if (!endpoint) return complain(endpoint.error().message, options.skip_absent && endpoint.error().absent ? exit_code::absent : exit_code::trouble);
  return execute(options, *plan, **endpoint);
}

int report_command(const ReportOptions& options) {
  if (options.junit.empty() && options.json.empty()) return complain("nothing to write; give --junit FILE, --json FILE or both", exit_code::usage);
  const Result<RunLog> log = read_ndjson(options.ndjson, [](const CaseResult&) {});
  if (!log) return complain(log.error().message, exit_code::usage);
  std::vector<std::pair<std::string, std::string>> reports;
  if (!options.junit.empty()) reports.emplace_back("junit", options.junit);
  if (!options.json.empty()) reports.emplace_back("json", options.json);
  const auto gate = log->run.properties.find("gate");
  return derive_reports(options.ndjson, reports, gate == log->run.properties.end() ? Gate{} : parse_gate(gate->second));
}

}  // namespace fieldproof
