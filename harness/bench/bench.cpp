#include "harness/bench/bench.hpp"

#include <fmt/format.h>
#include <algorithm>

#include "harness/bench/device_set_up.hpp"
#include "harness/bench/what_to_check.hpp"
#include "harness/exchange/p2p_blocks.hpp"
#include "harness/judge/recording.hpp"
#include "harness/safety/transposition.hpp"

namespace fieldproof::bench {

using exchange::PreparedCase;
using harness::Protocol;
using results::CaseResult;
using results::Verdict;
using vectors::Case;

namespace {

using nlohmann::json;

constexpr Duration start_patience =
    10s;  // a device that is started by the bench needs time to open its port
constexpr int most_unanswered = 4;  // writes that set up a case; then no further one is tried
constexpr int errors_to_stop = 5;   // then it is no longer the vectors, it is the bench

}  // namespace

Bench::Bench(endpoints::Endpoint& endpoint, const Protocol& protocol, BenchOptions options,
             std::shared_ptr<Standing> known)
    : endpoint_(endpoint),
      protocol_(protocol),
      options_(std::move(options)),
      arming_(protocol,
              {options_.endpoint_is_stimulus ? exchange::program_of(endpoint) : options_.stimulus,
               exchange::complete_blocks(options_.profile.prepared_blocks),
               options_.aux.endpoint != nullptr}),
      memory_({&endpoint, &protocol, options_.station}, patience_with(options_.profile),
              options_.aux, &arming_),
      exchange_(endpoint, protocol, timing(), options_.aux, &arming_),
      known_(known ? std::move(known) : std::make_shared<Standing>(options_.max_restarts)),
      eligibility_(endpoint, protocol, options_, arming_, memory_),
      recovery_(endpoint, options_, arming_, exchange_, *known_),
      saving_(endpoint, protocol, options_, eligibility_, recovery_) {}

exchange::ExchangeTiming Bench::timing() const {
  exchange::ExchangeTiming timing;
  timing.response_max = options_.profile.response_max;
  timing.promised_silence = std::max<Duration>(timing.promised_silence, 2 * timing.response_max);
  return timing;
}

judging::JudgeRules Bench::rules() const {
  judging::JudgeRules rules;
  const endpoints::Capabilities& can = endpoint_.capabilities();
  rules.guard_band = options_.profile.guard_band;
  const Duration declared = std::max(options_.profile.floor, can.timing_floor);
  rules.timing_floor = timing_floor(declared, options_.profile.response_max, known_->floor);
  rules.link_floor = gap_floor(declared, known_->floor);
  rules.turnaround_min = options_.profile.turnaround_min;
  rules.decisions = options_.profile.decisions;
  // Simulated time is exact, but for the moment at which a character counts as come.
  if (can.simulated) rules.period_tolerance = endpoint_.character_time();
  if (can.paced && can.real_device) rules.earliest = -endpoint_.character_time();
  rules.gap_floor = can.simulated                  ? Duration{}
                    : given_by_hand(known_->floor) ? known_->floor->given
                                                   : can.driver_silence.value_or(rules.link_floor);
  rules.gap_stated = options_.profile.max_gap > 0ns;
  // Cnet KO 4.3.1: 3.5 characters of 11 bits, that is 3.85 characters of 10.
  const auto wire_gap = Duration(endpoint_.character_time().count() * 385 / 100);
  rules.max_gap = options_.profile.max_gap > 0ns ? options_.profile.max_gap
                  : can.wire ? std::max({wire_gap, rules.link_floor, rules.gap_floor})
                             : shortest_judged;
  return rules;
}

/// For Endpoint::begin.
json Bench::begin_config(const Case& source) const {
  json config = endpoint_.capabilities().real_device
                    ? whole_config(options_.profile, options_.station, protocol_)
                    : json{{"station", options_.station}};
  if (!options_.profile.model.empty()) config["model"] = options_.profile.model;
  if (source.config.contains("role")) config["role"] = source.config["role"];
  return config;
}

Status Bench::start() {
  const int station = options_.station;
  json config = begin_config(Case());
  const bool listens = endpoint_.capabilities().real_device && !options_.client_cases.empty();
  if (listens) config["role"] = "client";
  silent_ = false;
  if (Status begun = endpoint_.begin(config); !begun) return begun;
  known_->starts = endpoint_.starts();
  known_->config = config;
  if (listens) {
    const Result<bool> asked = wait_for_request();
    known_->port_failed = !asked;
    if (!asked) return asked.error();
    return *asked ? ok() : Status(fail(why_nothing_is_asked({&endpoint_, &protocol_, station})));
  }
  const Result<exchange::Sign> sign = exchange_.first_sign(station, start_patience);
  known_->port_failed = !sign;
  if (!sign) return sign.error();
  known_->answers = *sign == exchange::Sign::alive;
  silent_ = *sign == exchange::Sign::silent;
  return known_->answers ? claim()
                         : Status(fail(why_silent({&endpoint_, &protocol_, station}, *sign)));
}

std::optional<exchange::Channel> Bench::silent_line() const {
  const exchange::Channel asked{&endpoint_, &protocol_, options_.station};
  if (!silent_ || exchange::implicit_transport(asked)) return std::nullopt;
  return asked;
}

/// A program is told that the case is over. What it asked last is given up before the next one
/// begins: `waits` for an answer, or the clocks of a stimulus, which stop with their case.
Status Bench::end_asking(const PreparedCase& prepared, bool waits) {
  if (!endpoint_.capabilities().real_device || !prepared.is_client()) return ok();
  const Result<bool> stopped = arming_.end();
  if (!stopped) return stopped.error();
  if (!*stopped || !(waits || prepared.runs_by_clock())) return ok();
  return exchange_.settle(std::max(prepared.client_settles(), arming_.time_out()) + 100ms);
}

/// The first case that can run shows whether the device asks at all. True as well where none can:
/// each says why.
Result<bool> Bench::wait_for_request() {
  arming_.greet();
  for (const Case* one : options_.client_cases) {
    if (!eligibility_.unmoved(*one).may_run()) continue;
    const Result<PreparedCase> prepared = eligibility_.prepare(*one);
    if (!prepared || !prepared->expects_requests()) continue;
    CaseResult given;
    arming_.next_is_probe();
    const bool begun = saving_.save(*prepared, given) && begin_case(*prepared, given);
    const Result<bool> asked = begun ? exchange_.anything_is_asked(*prepared, start_patience)
                                     : Result<bool>(fail(given.message));
    // One that gives up is judged, case by case.
    const bool ended = !asked && !asked.error().interrupted &&
                       (known_->client_gave_up || (arming_.declares() && arming_.gave_up()));
    if (ended && (arming_.revive() || known_->client_gave_up)) return true;
    if (!asked) return asked.error();
    if (const Status over = end_asking(*prepared, true); !over) return over.error();
    [[maybe_unused]] const std::string problem =
        saving_.restore();  // told at the end, where it lasts
    return asked;
  }
  return true;
}

Result<std::optional<AdapterFloor>> Bench::measure_floor() {
  if (endpoint_.capabilities().simulated || !known_->answers) return std::optional<AdapterFloor>();
  AdapterFloor floor;
  const auto measure = [&]() -> Status {
    Result<results::ResponseTimes> times =
        exchange_.time_probes(options_.station, floor_probes, floor_budget);
    if (!times) return times.error();
    floor.times = std::move(*times);
    return ok();
  };
  /// Before their requests can have been over.
  const auto answers_too_early = [&] {
    return endpoint_.capabilities().paced && floor.times.count() > 0 &&
           floor.times.least() < -to_ms(endpoint_.character_time());
  };
  Status measured = measure();
  if (measured && answers_too_early()) {
    // The answer to an earlier request came late, and each was taken for that of the next.
    floor.remark = "answers were one request behind, and were brought in step again";
    measured = exchange_.settle(options_.profile.response_max);
    if (measured) measured = measure();
  }
  if (measured && answers_too_early()) {
    floor.remark = fmt::format(
        "no wire: answers came up to {:.1f} ms before the request can have been sent over {}",
        -floor.times.least(), endpoint_.describe());
    endpoint_.has_no_wire();
    measured = measure();
  }
  if (!measured) return measured.error();
  return std::optional(std::move(floor));
}

std::string Bench::driver_silence() const {
  const endpoints::Capabilities& can = endpoint_.capabilities();
  if (!can.driver_silence) return {};
  return fmt::format("; silence inside a reply from {:.1f} ms ({})", to_ms(*can.driver_silence),
                     can.driver_silence_by);
}

Result<Fingerprint> Bench::fingerprint() {
  if (Status alive = start(); !alive) return alive.error();
  return read_fingerprint(endpoint_, protocol_, options_.station, options_.profile.response_max);
}

/// What is known of a real device may change from case to case.
const ReadyCase& Bench::ready_for(const Case& source) {
  if (last_ != &source || endpoint_.capabilities().real_device)
    last_ready_ = eligibility_.ready(source);
  last_ = &source;
  return last_ready_;
}

bool Bench::could_run(const Case& source) const {
  return eligibility_.ready(source).prepared.has_value();
}

std::vector<Protocol::Written> Bench::written_by(const Case& source) const {
  const Result<PreparedCase> prepared = eligibility_.prepare(source);
  if (!prepared || prepared->is_client()) return {};
  return eligibility_.written_by(*prepared);
}

CaseResult Bench::run(const Case& source) {
  CaseResult result = judging::result_of(source);
  if (declines(source, result)) return result;
  try_out(result);
  conclude(result);
  return result;
}

std::optional<CaseResult> Bench::run_ahead(const Case& source) {
  CaseResult result = judging::result_of(source);
  if (declines(source, result)) return std::nullopt;
  try_out(result);
  return known_->stopped.empty() ? std::optional(std::move(result)) : std::nullopt;
}

/// Not sent at all: `result` says why.
bool Bench::declines(const Case& source, CaseResult& result) {
  result.replay = options_.replay + "'" + source.id + "'";
  if (vectors::is_client_case(source) && endpoint_.capabilities().real_device) arming_.greet();
  const ReadyCase& ready = ready_for(source);
  if (ready.prepared && known_->stopped.empty()) return false;
  result.verdict = ready.prepared ? Verdict::blocked : ready.why.verdict;
  result.message = ready.prepared ? known_->stopped : ready.why.reason;
  return true;
}

/// Once it is not declined.
void Bench::try_out(CaseResult& result) {
  const ReadyCase& ready = last_ready_;
  const Time begun = endpoint_.now();
  for (const results::Move& move : ready.moves)
    result.notes.push_back(safety::note_of(move, protocol_));
  set_up_answered_ = true;
  execute(*ready.prepared, result);
  if (known_->port_failed && !known_->interrupted) recovery_.start_again(result);
  if (endpoint_.capabilities().shared) look_for_others(*ready.prepared, result);
  if (endpoint_.capabilities().real_device && !ready.prepared->is_client() &&
      known_->stopped.empty() && known_->disturbed == 0)
    known_->stopped = known_->worth_asking.after(result, protocol_, set_up_answered_);
  if (!result.recording.stimulus.empty()) result.recording.moves = ready.moves;
  if (endpoint_.capabilities().simulated) results::shift(result, -begun);
}

/// On simulated time each case begins where the one before it ended, whoever ran it.
void Bench::conclude(CaseResult& result) {
  if (endpoint_.capabilities().simulated) {
    results::shift(result, known_->simulated);
    if (!result.exchange.empty()) known_->simulated = result.exchange.back().end;
  }
  known_->readings.note(result);
  known_->set_up_findings.note(result);
  known_->errors_in_a_row = result.verdict == Verdict::error ? known_->errors_in_a_row + 1 : 0;
  if (known_->errors_in_a_row == errors_to_stop && known_->stopped.empty())
    recovery_.stop(fmt::format("{} errors in a row: {}", errors_to_stop, result.message));
}

void Bench::execute(const PreparedCase& prepared, CaseResult& result) {
  judging::note_transposition(prepared, result);
  const bool real = endpoint_.capabilities().real_device;
  if (real) {
    if (!set_up_device(prepared, result)) return;
    const bool saved = saving_.save(prepared, result);
    set_up_answered_ = saving_.was_answered();
    if (!saved) return;
  }
  if (prepare_device(prepared, result)) {
    if (real) saving_.before_exchange(prepared);
    exchange(prepared, result);
    if (real) saving_.after_exchange(result, known_->port_failed);
  }
  if (!real) return;
  set_up_answered_ = saving_.put_back(result, !known_->stopped.empty()) && set_up_answered_;
  if (const Status back = endpoint_.put_back(); !back)
    result.notes.push_back("not put back what it set: " + back.error().message);
}

void Bench::exchange(const PreparedCase& prepared, CaseResult& result) {
  exchange::Transcript transcript = exchange_.run(prepared);
  if (!transcript.trouble)
    if (const Status over = end_asking(prepared, exchange::leaves_open(transcript)); !over)
      transcript.trouble = over.error();
  judge_exchange(prepared, transcript, result);
  recovery_.after(prepared, transcript, result);
  // The device is one answer behind: what is still to come is not the next case's.
  const double earliest = to_ms(result.recording.earliest);
  if (earliest < 0 &&
      std::ranges::any_of(result.response_ms, [&](double ms) { return ms < earliest; }))
    if (const Status quiet = exchange_.settle(options_.profile.response_max); !quiet)
      recovery_.stop("the port failed after " + result.id + ": " + quiet.error().message,
                     &quiet.error());
}

std::string Bench::put_back() {
  if (!endpoint_.capabilities().real_device || saving_.open_places().empty()) return {};
  // Written where the device was set up so; with one that was started anew its memory is gone.
  if (!endpoint_.capabilities().can_power_cycle)
    if (const Status begun = endpoint_.begin(begin_config(Case())); !begun)
      return saving_.open_places();
  [[maybe_unused]] const std::string problem = saving_.restore();
  return saving_.open_places();
}

std::string Bench::leave_as_declared() {
  const endpoints::Capabilities& can = endpoint_.capabilities();
  if (!can.control || can.can_power_cycle || !known_->stopped.empty()) return {};
  const Status begun = endpoint_.begin(begin_config(Case()));
  return begun ? "" : "the configuration: " + begun.error().message;
}

/// A real device is given what the case needs before anything of it is read. One that cannot be, or
/// does not answer then, says nothing about the clause.
bool Bench::set_up_device(const PreparedCase& prepared, CaseResult& result) {
  const auto give_up = [&](Verdict verdict, const std::string& why) {
    result.verdict = verdict;
    result.message = why;
    return false;
  };
  if (!not_up_.empty()) return give_up(Verdict::blocked, not_up_);
  const json config = begin_config(*prepared.source);
  const Status begun = endpoint_.begin(config);
  if (!begun && begun.error().refused) return give_up(Verdict::blocked, begun.error().message);
  if (!begun) {
    recovery_.stop(begun.error().interrupted
                       ? "interrupted"
                       : "the port failed in " + result.id + ": " + begun.error().message,
                   &begun.error());
    return give_up(Verdict::error, begun.error().message);
  }
  const bool started = just_started_ = known_->starts != endpoint_.starts();
  const bool changed = endpoint_.capabilities().control && known_->config != config;
  known_->starts = endpoint_.starts();
  known_->config = config;
  if (!started && !changed) return true;
  if (prepared.is_shut_out()) return true;
  if (prepared.is_client()) return !started || arming_.started_anew();  // it answers no probe
  const Result<exchange::Sign> sign = answers_when_set_up(prepared, started);
  if (sign && *sign == exchange::Sign::alive) return true;
  if (!sign && sign.error().interrupted) recovery_.stop("interrupted", &sign.error());
  not_up_ = fmt::format("the device does not answer once it is set up for this case{}",
                        sign ? "" : ": " + sign.error().message);
  return give_up(Verdict::blocked, not_up_);
}

Result<exchange::Sign> Bench::answers_when_set_up(const PreparedCase& prepared, bool started) {
  const Duration patience = started ? start_patience : 3 * options_.profile.response_max;
  return exchange_.anything_answers(prepared.station, patience, prepared.reply_delay, true);
}

bool Bench::prepare_device(const PreparedCase& prepared, CaseResult& result) {
  const bool real = endpoint_.capabilities().real_device;
  const auto give_up = [&](Verdict verdict, const Error& error) {
    result.verdict = verdict;
    result.message = error.message;
    if (error.interrupted)
      recovery_.stop("interrupted", &error);
    else if (real && verdict == Verdict::error)
      recovery_.stop("the port failed in " + result.id + ": " + error.message, &error);
    return false;
  };
  if (!real)
    if (Status begun = endpoint_.begin(eligibility_.device_config(*prepared.source)); !begun)
      return give_up(Verdict::error, begun.error());
  if (real)
    if (const Status fresh = be_fresh(prepared, result); !fresh)
      return give_up(Verdict::blocked, fresh.error());
  if (real && !prepared.is_client() && !meets_premises(prepared, result)) return false;
  // What a clock asked between the cases is no part of this one. It waits for its answer before it
  // asks again.
  if (real && prepared.runs_by_clock())
    if (Status quiet = exchange_.settle(50ms); !quiet)
      return give_up(Verdict::error, quiet.error());
  if (begin_case(prepared, result)) return true;
  if (!real || prepared.is_client() || known_->interrupted) return false;
  if (!memory_.refused() && result.verdict == Verdict::blocked) return false;  // --control says no
  if (!memory_.refused()) return give_up(Verdict::error, Error{result.message});
  if (memory_.lost()) recovery_.look_for_device(result, result.message);
  return false;
}

/// Who counts what was asked since power-on has not been asked then.
Status Bench::be_fresh(const PreparedCase& prepared, CaseResult& result) {
  const bool counts = prepared.counts_from_power_on();
  if (!counts && (!prepared.source->fresh || just_started_)) return ok();
  const Status renewed = prepared.is_client() ? refuse("") : endpoint_.renew();
  if (renewed) result.notes.push_back("switched the device off and on");
  if (renewed || counts) return renewed;
  if (recovery_.power_cycle(result, prepared.is_client())) return ok();
  return fail("the device did not come back from the power cycle");
}

/// What is not as it must be before the case; empty: all is.
Result<std::string> Bench::unmet_premise(const PreparedCase& prepared) {
  const exchange::Leaving leaving(memory_);
  for (const std::string& axis : eligibility_.moved_axes(prepared))
    for (const auto& [address, value] : protocol_.premises(axis)) {
      const Result<std::string> holds = memory_.get(prepared, address, value.size());
      if (!holds) return holds.error();
      if (*holds != value)
        return fmt::format("axis {} is not where the case begins: {} holds {}, not {}", axis,
                           address, *holds, value);
    }
  return std::string();
}

/// A device that can be switched off and on begins anew.
bool Bench::meets_premises(const PreparedCase& prepared, CaseResult& result) {
  Result<std::string> unmet = unmet_premise(prepared);
  const bool can =
      endpoint_.capabilities().can_power_cycle || !options_.power_cycle_command.empty();
  if (unmet && !unmet->empty() && can && recovery_.power_cycle(result))
    unmet = unmet_premise(prepared);
  if (unmet && unmet->empty()) return true;
  result.verdict = unmet ? Verdict::blocked : Verdict::error;
  result.message =
      unmet ? *unmet + "; bring it there (home it, clear the error), and run this case again"
            : unmet.error().message;
  return false;
}

/// What cannot be set is as the case begins, or the case cannot run. Errors that are not of the
/// device or of the value are of the port (MemoryAccess::refused).
Status Bench::holds(const PreparedCase& prepared, const Protocol::Setting& given,
                    const std::string& why_not_set) {
  const auto& [address, hex] = given;
  const Result<std::string> held = memory_.get(prepared, address, hex.size());
  if (!held) return held.error();
  if (from_hex(*held) == from_hex(hex)) return ok();
  Error error = fail(fmt::format("cannot set {}: {}; it holds {}, and the case begins with {}",
                                 address, why_not_set, *held, hex));
  error.refused = true;
  return error;
}

/// Sets the given memory; whatever makes a real client ask is told of the case.
bool Bench::begin_case(const PreparedCase& prepared, CaseResult& result) {
  const auto give_up = [&](Verdict verdict, const Error& error) {
    result.verdict = verdict;
    result.message = error.message;
    if (error.interrupted) recovery_.stop("interrupted", &error);
    return false;
  };
  const auto set = [&](exchange::MemoryRun run) {
    const Status done = memory_.set(prepared, run);
    if (done)
      for (const auto& [address, hex] : run)
        result.exchange.push_back({results::Event::Kind::note,
                                   endpoint_.now(),
                                   endpoint_.now(),
                                   {},
                                   fmt::format("given {} = {}", address, hex)});
    return done;
  };
  const exchange::Leaving leaving(memory_);  // the case has all connections of the device
  const bool asks = prepared.is_client() && endpoint_.capabilities().real_device;
  if (asks) {
    if (const Status begun =
            arming_.begin(*prepared.source, eligibility_.device_config(*prepared.source));
        !begun)
      return give_up(arming_.gave_up() ? Verdict::fail : Verdict::error, begun.error());
    // A flag that an earlier case left on would have no rising edge.
    if (arming_.aux())
      for (const std::string& flag : arming_.flags()) {
        const Protocol::Setting off{flag, "00"};
        if (const Status reset = set({&off, 1}); !reset)
          return give_up(Verdict::error, reset.error());
      }
  }
  for (const exchange::MemoryRun run : memory_.runs(prepared, prepared.source->memory)) {
    if (known_->set_ups_unanswered >= most_unanswered)
      return give_up(Verdict::blocked,
                     fail(fmt::format("{}cannot set {}: no answer{}", exchange::set_up_failure,
                                      run.front().first, not_tried)));
    const Protocol::Setting given = exchange::as_one(run);
    const std::string why_not = eligibility_.only_read(prepared, given);
    const Status done = why_not.empty() ? set(run) : holds(prepared, given, why_not);
    known_->set_ups_unanswered *= memory_.lost() ? 1 : 0;
    if (done) continue;
    if (done.error().refused) return give_up(Verdict::blocked, done.error());
    if (!memory_.refused())
      return give_up(arming_.gave_up() ? Verdict::fail : Verdict::error, done.error());
    const Time now = endpoint_.now();
    result.exchange.push_back({results::Event::Kind::note, now, now, {}, memory_.said()});
    set_up_answered_ = !memory_.unserved() || only_writes_are_unanswered(prepared);
    return give_up(Verdict::blocked,
                   Error{std::string(exchange::set_up_failure) + done.error().message});
  }
  return true;
}

/// It was silent when memory was set, and answers the bench's probe: what sets nothing goes on.
bool Bench::only_writes_are_unanswered(const PreparedCase& prepared) {
  if (!memory_.lost() || prepared.is_client() || !known_->answers) return false;
  const Result<exchange::Sign> alive =
      exchange_.anything_answers(prepared.station, 3 * options_.profile.response_max);
  const bool answers = alive && *alive == exchange::Sign::alive;
  known_->set_ups_unanswered += answers ? 1 : 0;
  return answers;
}

void Bench::judge_exchange(const PreparedCase& prepared, const exchange::Transcript& transcript,
                           CaseResult& result) {
  const judging::JudgeRules by = rules();
  judging::take_judgement(judging::judge(prepared, transcript, by, protocol_), result);
  result.recording = judging::make_recording(prepared, transcript, by);
  const Duration driver = endpoint_.capabilities().driver_silence.value_or(Duration{});
  judging::take_exchange(transcript, protocol_.longest_frame(), result,
                         std::min(driver, by.max_gap));
  if (const std::string errors = endpoint_.line_errors(); !errors.empty())
    result.notes.push_back("the driver counted " + errors);
}

}  // namespace fieldproof::bench
