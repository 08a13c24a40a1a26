#include <fmt/format.h>
#include <algorithm>
#include <chrono>
#include <filesystem>

#include "harness/bench/benches.hpp"
#include "harness/bench/files/waivers.hpp"
#include "harness/cli/commands.hpp"
#include "harness/endpoints/kinds.hpp"
#include "harness/explore/client_sequences.hpp"
#include "harness/explore/explorer.hpp"
#include "harness/explore/server_sequences.hpp"
#include "harness/explore/vector_text.hpp"
#include "harness/judge/judge.hpp"
#include "harness/run/long_texts.hpp"
#include "harness/run/look_on.hpp"
#include "harness/run/ports.hpp"
#include "harness/run/run_info.hpp"
#include "harness/run/run_plan.hpp"
#include "harness/run/run_report.hpp"
#include "harness/run/timestamp.hpp"
#include "harness/system/interrupt.hpp"
#include "harness/vectors/filter.hpp"
#include "harness/vectors/loader.hpp"
#include "reports/text/report_file.hpp"
#include "src/base/duration.hpp"

namespace fieldproof::cli {

using bench::Benches;
using explore::Explorer;
using results::CaseResult;
using results::Verdict;
using run::RunPlan;
using run::RunReport;

namespace {

constexpr std::uint64_t usual_requests = 100'000;
constexpr Duration usual_time = std::chrono::minutes(10);  // where time is real
using Clock = std::chrono::steady_clock;

/// The model that the device is held against.
std::string model_of(const RunPlan& plan) {
  const harness::Protocol& protocol = *plan.protocols.front();
  const std::string& model = plan.bench.profile.model;
  return protocol.has_model(model) ? model : protocol.models().front();
}

explore::Device device_of(const RunPlan& plan, Benches& bench) {
  return {.protocol = plan.protocols.front(),
          .run = [&bench](const vectors::Case& one) { return bench.run(one); },
          .alive =
              [&bench] {
                return bench.stopped().empty() && !bench.interrupted() && !os::interrupted();
              },
          .real_time = !endpoints::capabilities_of(plan.endpoint).simulated};
}

bool over_the_wire(const RunPlan& plan) {
  return !endpoints::capabilities_of(plan.endpoint).back_door;
}

/// What a real device declares, as far as its model knows it; the line is the port's.
nlohmann::json config_of(const RunPlan& plan) {
  nlohmann::json config = nlohmann::json::object();
  if (endpoints::kind_of(plan.endpoint).emulated) return config;
  for (const auto& [key, value] : plan.bench.profile.config.items())
    if (key != "line" && key != "bench_line" && key != "station" &&
        plan.protocols.front()->make_device(model_of(plan), {{key, value}}))
      config[key] = value;
  return config;
}

/// A waiver of a finding, else of a case of `run`.
bool is_of_a_finding(const bench::Waiver& waiver) {
  return waiver.id.find("/explore/") != std::string::npos;
}

/// Without those that the profile excludes, or a waiver is about: they are not what this device is
/// held to.
void leave_out(RunPlan& plan) {
  const auto erase = [&](const std::string& pattern) {
    std::erase_if(plan.vectors.cases, [&](const vectors::Case& one) {
      return vectors::matches_filter(one.id, pattern);
    });
  };
  for (const auto& [pattern, reason] : plan.bench.profile.exclude) erase(pattern);
  for (const bench::Waiver& waiver : plan.waivers)
    if (!is_of_a_finding(waiver)) erase(waiver.id);
  std::erase_if(plan.waivers, [](const auto& waiver) { return !is_of_a_finding(waiver); });
}

/// The waivers of `run` know no findings.
Result<RunPlan> plan_of(run::RunOptions options, const harness::Protocols& protocols) {
  Result<std::vector<bench::Waiver>> waivers = bench::load_waivers(options.waivers);
  if (!waivers) return waivers.error();
  options.waivers.clear();
  // Nothing is asked but what vectors of the protocol ask.
  if (const harness::Protocol* protocol = protocols.find(options.protocol))
    options.filter = vectors::folder_of(*protocol) + "/*";
  Result<RunPlan> plan = run::make_run_plan(options, protocols);
  if (!plan) return plan;
  plan->waivers = std::move(*waivers);
  leave_out(*plan);
  return plan;
}

/// Where requests may go to.
explore::Server server_of(const RunPlan& plan, const harness::Protocol& configured,
                          const nlohmann::json& config) {
  const bool emulated = endpoints::kind_of(plan.endpoint).emulated;
  explore::Server server{
      .protocol = &configured,
      .station = plan.bench.station,
      .config = config,
      .over_the_wire = over_the_wire(plan),
      .learns = !plan.bench.profile.decisions.all,
      .room = {},
      .allowed = [&plan, &configured, emulated](ByteView request) {
        const std::vector<harness::Protocol::Written> written = configured.written_by(request);
        return emulated || (plan.bench.fence.objection(written, configured).empty() &&
                            plan.bench.fence.motion_objection(written, configured).empty());
      }};
  if (!emulated)
    server.room = [&plan, &configured](const std::string& area) {
      std::vector<safety::WriteFence::Words> room =
          plan.bench.fence.allowed(area, configured.output_areas());
      const std::uint32_t words = configured.words_of(area);
      for (safety::WriteFence::Words& one : room) one.last = std::min(one.last, words - 1);
      std::erase_if(room, [&](const auto& one) { return words == 0 || one.first > one.last; });
      return room;
    };
  return server;
}

Error nothing_to_explore(const harness::Protocol& protocol, std::string_view role) {
  const std::string why = protocol.has_frames()
                              ? fmt::format("no vector has a request for such a {}", role)
                              : "no manual prints its frames";
  return fail(fmt::format("{} cannot be explored: {}", protocol.name(), why));
}

/// Requests to a server. `configured` outlives it.
Result<std::unique_ptr<explore::Inventor>> server_sequences(const RunPlan& plan,
                                                            const harness::Protocol& configured,
                                                            const nlohmann::json& config,
                                                            std::uint64_t seed) {
  const harness::Protocol& protocol = *plan.protocols.front();
  const std::string model = model_of(plan);
  std::vector<explore::Request> requests =
      explore::requests_of(plan.vectors.cases, protocol, model);
  if (requests.empty() || !protocol.memory()) return nothing_to_explore(protocol, "server");
  explore::Server server = server_of(plan, configured, config);
  Result<explore::Oracle> oracle = explore::Oracle::open(protocol, model, server.station, config);
  if (!oracle) return oracle.error();
  std::unique_ptr<explore::Inventor> inventor = std::make_unique<explore::ServerSequences>(
      std::move(server), std::move(*oracle), std::move(requests), seed);
  if (!inventor->can_invent())
    return fail(
        "nothing can be explored: each request names memory that it may not set up; give "
        "--allow-write RANGES");
  return inventor;
}

/// Blocks of a client.
Result<std::unique_ptr<explore::Inventor>> client_sequences(const RunPlan& plan,
                                                            std::uint64_t seed) {
  const harness::Protocol& protocol = *plan.protocols.front();
  std::string model = model_of(plan);
  explore::ClientPool pool = explore::client_pool(plan.vectors.cases, protocol, model);
  // What answers is not always what asks: an inverter, and a PLC.
  for (const vectors::Case& one : plan.vectors.cases) {
    if (!pool.groups.empty()) break;
    if (one.models.empty() || one.models.front() == model) continue;
    model = one.models.front();
    pool = explore::client_pool(plan.vectors.cases, protocol, model);
  }
  if (pool.groups.empty()) return nothing_to_explore(protocol, "client");
  Result<std::unique_ptr<explore::ClientSequences>> made = explore::ClientSequences::open(
      {&protocol, model, over_the_wire(plan)}, std::move(pool), seed);
  if (!made) return made.error();
  return std::unique_ptr<explore::Inventor>(std::move(*made));
}

/// What is known of one kind of request: how it was answered.
CaseResult seen_result(const harness::Protocol& protocol, const std::string& topic,
                       const std::string& kind,
                       const std::map<std::string, std::uint64_t>& answers) {
  CaseResult result;
  result.id = fmt::format("{}/explore/{}/{}", vectors::folder_of(protocol), topic, kind);
  result.protocol = protocol.name();
  result.level = "must";
  result.basis = "decision";
  result.verdict = Verdict::pass;
  std::uint64_t all = 0;
  std::string sorts;
  for (const auto& [sort, times] : answers) {
    all += times;
    sorts += fmt::format("{}{} {}", sorts.empty() ? "" : ", ", sort, times);
  }
  result.title = fmt::format("{} {} requests are answered as the model answers them", topic, kind);
  result.notes.push_back(fmt::format("{} requests: {}", all, sorts));
  return result;
}

/// What is known beside: lines for the engineer, in a result that is none of a case.
CaseResult known_result(const harness::Protocol& protocol, const std::string& name,
                        const std::string& title, const std::vector<std::string>& lines) {
  CaseResult result;
  result.id = fmt::format("{}/explore/{}", vectors::folder_of(protocol), name);
  result.protocol = protocol.name();
  result.title = title;
  result.level = "info";
  result.basis = "decision";
  result.verdict = Verdict::info;
  result.message = fmt::format("{} lines", lines.size());
  result.notes = lines;
  return result;
}

/// One exploration: sequences to results.
class Exploration {
 public:
  Exploration(const ExploreOptions& options, RunPlan& plan, std::vector<Benches>& ports,
              RunReport& report, Explorer& explorer)
      : options_(options), plan_(plan), ports_(ports), report_(report), explorer_(explorer) {
    if (options_.requests > 0) most_ = options_.requests;
    if (plan_.soak > 0ns) longest_ = plan_.soak;
    if (most_ > 0 || longest_ > 0ns) return;
    if (ports_.front().simulated())
      most_ = usual_requests;
    else
      longest_ = usual_time;
  }

  RunReport::End execute(const Status& started) {
    if (!started) {
      end_.interrupted = started.error().interrupted;
      if (!end_.interrupted) end_.trouble = started.error().message;
    } else {
      explore_it();
      report_what_was_found();
    }
    put_back();
    return end_;
  }

 private:
  Duration elapsed() const { return Clock::now() - started_; }

  bool goes_on() const {
    if (os::interrupted() || explorer_.exhausted()) return false;
    if (longest_ > 0ns && elapsed() >= longest_) return false;
    return most_ == 0 || explorer_.requests_sent() < most_;
  }

  bool fails(const explore::Finding& finding) {
    CaseResult result = finding.result;
    waivers_.apply(result);
    return results::gates(result.verdict, report_.gate());
  }
  bool failed() {
    return std::ranges::any_of(explorer_.findings(),
                               [&](const auto& one) { return fails(one.second); });
  }

  void explore_it() {
    started_ = Clock::now();
    if (longest_ > 0ns && plan_.soak == 0ns)
      report_.say(
          fmt::format("explores for {}, since time is real here; else give --requests or "
                      "--duration",
                      in_minutes(longest_)));
    while (goes_on() && ports_.front().stopped().empty()) {
      tell_pace();
      report_.show_progress(progress());
      explorer_.step();
      if (options_.run.fail_fast && failed()) break;
    }
    end_.interrupted = os::interrupted();
    if (!end_.interrupted) end_.trouble = ports_.front().stopped();
    if (explorer_.exhausted())
      report_.say("no more requests fit into what may be written; give --allow-write more words");
  }

  static std::string in_minutes(Duration time) {
    const double seconds = std::chrono::duration<double>(time).count();
    return seconds < 100 ? fmt::format("{:.0f} s", seconds)
                         : fmt::format("{:.0f} min", seconds / 60);
  }
  /// Of one request; the bench keeps the pauses of the protocol between them, as in a run.
  double pace() const {
    return std::chrono::duration<double>(elapsed()).count() /
           static_cast<double>(std::max<std::uint64_t>(1, explorer_.requests_sent()));
  }
  /// Until both limits that are given.
  Duration to_go() const {
    Duration left = longest_ > 0ns ? longest_ - elapsed() : Duration::max();
    if (most_ > 0)
      left = std::min(
          left,
          std::chrono::duration_cast<Duration>(std::chrono::duration<double>(
              pace() * static_cast<double>(most_ - std::min(most_, explorer_.requests_sent())))));
    return std::max(left, Duration{});
  }

  std::string progress() const {
    const std::string of = most_ > 0 ? fmt::format(" of {}", most_) : "";
    return fmt::format("{}{} requests, {} findings, ~{} to go", explorer_.requests_sent(), of,
                       explorer_.findings().size(), in_minutes(to_go()));
  }

  /// Once, when enough has been seen of it: nobody waits for hours unawares.
  void tell_pace() {
    if (told_pace_ || elapsed() < 3s || explorer_.requests_sent() == 0) return;
    told_pace_ = true;
    report_.say(fmt::format("{:.1f} requests a second here: about {} to go", 1 / pace(),
                            in_minutes(to_go())));
  }

  void report_what_was_found() {
    const harness::Protocol& protocol = *plan_.protocols.front();
    report_.say(
        fmt::format("{} requests of {} in {} sequences, {} of them judged, seed {}: "
                    "{} findings",
                    explorer_.requests_sent(), protocol.name(), explorer_.sequences(),
                    explorer_.judged(), options_.run.seed, explorer_.findings().size()));
    for (const auto& [what, answers] : explorer_.seen())
      report_.add(seen_result(protocol, what.first, what.second, answers));
    report_what_is_known(protocol);
    int number = 0;
    for (const auto& [why, seen] : explorer_.unjudged()) {
      CaseResult result = seen.first;  // its exchange is an example
      if (result.message != why.second) result.notes.push_back("the first: " + result.message);
      result.id = fmt::format("{}/explore/not_judged/{}", vectors::folder_of(protocol), ++number);
      result.protocol = protocol.name();
      result.verdict = why.first;
      result.message = run::bounded(
          fmt::format("{} sequence{}: {}", seen.times, seen.times == 1 ? "" : "s", why.second));
      result.replay.clear();
      report_.add(result);
    }
    for (const auto& [mark, finding] : explorer_.findings()) report_.add(result_of(finding));
  }

  void report_what_is_known(const harness::Protocol& protocol) {
    const explore::Inventor::Known known = explorer_.known();
    for (const std::string& line : known.limits) report_.say("  " + line);
    std::vector<std::string> map = known.services;
    map.insert(map.end(), known.limits.begin(), known.limits.end());
    if (!map.empty())
      report_.add(known_result(protocol, "map", "Services by answer, counts, ends of areas", map));
    for (const std::string& line : known.readings) report_.say("  reads " + line);
    if (!known.readings.empty())
      report_.add(known_result(protocol, "readings",
                               "What nobody says is right, as this device reads it",
                               known.readings));
  }

  CaseResult result_of(const explore::Finding& finding) {
    CaseResult result = finding.result;
    const std::filesystem::path file =
        std::filesystem::path(options_.run.out) / "findings" /
        (finding.shortest.id.substr(finding.shortest.id.rfind('/') + 1) + ".json");
    result.notes.push_back(finding.confirmed
                               ? "shown again three times in a row"
                               : "seen once, not again: it depends on what was before");
    std::uint64_t times = 0;
    std::string by;
    for (const auto& [topic, count] : finding.shown_by) {
      times += count;
      by += fmt::format("{}{} {}", by.empty() ? ": " : ", ", topic, count);
    }
    result.notes.push_back(run::bounded(fmt::format("shown by {} sequences{}", times, by)));
    result.notes.push_back(finding.shortest.why);
    if (const Status written = write(file, explore::vector_text(finding.shortest)); !written)
      end_.trouble = written.error().message;
    result.replay = fmt::format("{} --vectors {}", base_command(), run::shell_word(file.string()));
    waivers_.apply(result);
    long_texts_.shorten(result);
    return result;
  }

  /// Without the vectors of the run, whose place the finding takes.
  std::string base_command() const {
    std::string replay = plan_.bench.replay.substr(0, plan_.bench.replay.rfind(" --filter"));
    const std::string others = " --vectors " + run::shell_word(options_.run.vectors);
    const std::size_t at = replay.find(others);
    if (!options_.run.vectors.empty() && at != replay.npos) replay.erase(at, others.size());
    return replay;
  }

  static Status write(const std::filesystem::path& file, const std::string& text) {
    std::error_code error;
    std::filesystem::create_directories(file.parent_path(), error);
    Result<text::ReportFile> report = text::ReportFile::create(file.string());
    if (!report) return report.error();
    report->out() << text;
    return report->commit();
  }

  void put_back() {
    if (end_.interrupted) os::clear_interrupt();
    if (const std::string open = ports_.front().put_back(); !open.empty() && !plan_.ends_with_run)
      end_.not_restored = run::not_restored(open, plan_.journal);
    if (const std::string writes = ports_.front().doubtful_writes(); !writes.empty())
      end_.not_restored += (end_.not_restored.empty() ? "" : "\n") + run::not_sure(writes);
  }

  const ExploreOptions& options_;
  RunPlan& plan_;
  std::vector<Benches>& ports_;
  RunReport& report_;
  Explorer& explorer_;
  run::LongTexts long_texts_;
  RunReport::End end_;
  bench::Waivers waivers_{plan_.waivers, run::timestamp().substr(0, 10), plan_.identity.firmware};
  std::uint64_t most_ = 0;  // 0: as many as go
  Duration longest_{};      // 0: as long as it takes
  bool told_pace_ = false;
  Clock::time_point started_ = Clock::now();
};

int execute(const ExploreOptions& options, RunPlan& plan, std::vector<Benches>& ports,
            RunReport& report, Explorer& explorer) {
  std::vector<std::string> floors;
  Status started = ports.front().start();
  if (!started) {
    started = run::looked_on(started.error(), ports.front(), plan);
  } else if (Result<std::string> floor =
                 plan.floor ? Result<std::string>(ports.front().use_floor(*plan.floor))
                            : ports.front().measure_floor();
             floor) {
    floors.push_back(*floor);
  } else {
    started = floor.error();
  }
  results::RunInfo info = run::run_info(options.run, plan, ports, floors);
  info.properties["seed"] = std::to_string(options.run.seed);
  if (const Status begun = report.begin(info); !begun)
    return run::complain(begun.error().message, run::exit_code::trouble);
  Exploration exploration(options, plan, ports, report, explorer);
  return report.finish(exploration.execute(started));
}

}  // namespace

int explore_command(const ExploreOptions& given, const harness::Protocols& protocols) {
  ExploreOptions options = given;
  if (options.run.seed < 0)
    options.run.seed =
        static_cast<int>(std::chrono::system_clock::now().time_since_epoch().count() % 100'000);
  Result<RunPlan> plan = plan_of(options.run, protocols);
  if (!plan) return run::complain(plan.error().message, run::exit_code::usage);
  const harness::Protocol& protocol = *plan->protocols.front();
  const std::string model = model_of(*plan);
  const nlohmann::json config = config_of(*plan);
  const Result<std::unique_ptr<harness::Protocol>> configured = protocol.configured(model, config);
  if (!configured) return run::complain(configured.error().message, run::exit_code::usage);
  const std::uint64_t seed = static_cast<std::uint64_t>(options.run.seed);
  Result<std::unique_ptr<explore::Inventor>> inventor =
      options.run.role == "client"
          ? client_sequences(*plan, seed)
          : server_sequences(*plan, *configured ? **configured : protocol, config, seed);
  if (!inventor) return run::complain(inventor.error().message, run::exit_code::nothing);
  os::catch_interrupts();
  Result<run::ReportPaths> paths = run::make_report_paths(options.run.out, options.run.json,
                                                          options.run.junit, options.run.html);
  if (!paths) return run::complain(paths.error().message, run::exit_code::trouble);
  if (const Status opened = run::open_journals(options.run, *plan); !opened)
    return run::complain(opened.error().message, run::exit_code::usage);
  Result<run::Devices> devices = run::open_devices(*plan);
  if (!devices)
    return run::complain(devices.error().message, options.run.skip_absent && devices.error().absent
                                                      ? run::exit_code::absent
                                                      : run::exit_code::trouble);
  std::vector<Benches>& ports = devices->ports;
  Result<RunReport> report = RunReport::create(
      std::move(*paths), run::console_options(run::gate_of(options.run), options.run.verbose));
  if (!report) return run::complain(report.error().message, run::exit_code::trouble);
  Explorer explorer(device_of(*plan, ports.front()), std::move(*inventor));
  return execute(options, *plan, ports, *report, explorer);
}

}  // namespace fieldproof::cli
