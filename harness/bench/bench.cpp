#include "harness/bench/bench.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cstdlib>

#include "harness/bench/what_to_check.hpp"
#include "harness/exchange/p2p_blocks.hpp"
#include "harness/judge/recording.hpp"
#include "harness/notation/notation.hpp"
#include "harness/safety/placement.hpp"
#include "harness/safety/transposition.hpp"
#include "harness/system/hook.hpp"
#include "harness/vectors/loader.hpp"

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
constexpr Duration revive_patience = 10s;
constexpr int errors_to_stop = 5;  // then it is no longer the vectors, it is the bench
/// Behind a pty or a socket writes can arrive milliseconds apart, and the emulator's
/// inter-character time has a floor of 20 ms: shorter times than this prove nothing there.
constexpr Duration shortest_judged = 100ms;

/// What a device has that declares nothing.
const json& default_config() {
  static const json config{{"role", "server"},
                           {"mode", "run"},
                           {"inter_character_ms", 0},
                           {"delay_ms", 0},
                           {"rs485", false}};
  return config;
}

std::string plain(const json& value) {
  return value.is_string() ? value.get<std::string>() : value.dump();
}

}  // namespace

Bench::Bench(endpoints::Endpoint& endpoint, const Protocol& protocol, BenchOptions options)
    : endpoint_(endpoint),
      protocol_(protocol),
      options_(std::move(options)),
      arming_(protocol,
              {options_.endpoint_is_stimulus ? exchange::program_of(endpoint) : options_.stimulus,
               exchange::complete_blocks(options_.profile.prepared_blocks),
               options_.aux.endpoint != nullptr}),
      memory_({&endpoint, &protocol, options_.station}, options_.profile.response_max, options_.aux,
              &arming_),
      exchange_(endpoint, protocol, timing(), options_.aux, &arming_),
      saved_(endpoint, protocol, options_.profile.response_max, options_.device, options_.journal),
      saved_over_aux_(options_.aux.endpoint ? *options_.aux.endpoint : endpoint,
                      options_.aux.protocol ? *options_.aux.protocol : protocol,
                      options_.profile.response_max, options_.aux_device, options_.journal),
      worth_asking_(options_.max_restarts) {}

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
  rules.timing_floor = timing_floor(declared, options_.profile.response_max, floor_);
  rules.link_floor = gap_floor(declared, floor_);
  rules.turnaround_min = options_.profile.turnaround_min;
  rules.binding_decisions = rules.binding_timing = options_.profile.binding_decisions;
  // Simulated time is exact, but for the moment at which a character counts as come.
  if (can.simulated) rules.period_tolerance = endpoint_.character_time();
  // Cnet KO 4.3.1: 3.5 characters of 11 bits, that is 3.85 characters of 10.
  const auto wire_gap = Duration(endpoint_.character_time().count() * 385 / 100);
  rules.max_gap = options_.profile.max_gap > 0ns ? options_.profile.max_gap
                  : can.wire                     ? std::max(wire_gap, rules.link_floor)
                                                 : shortest_judged;
  return rules;
}

Status Bench::start() {
  const int station = options_.station;
  json config = json::object();
  config["station"] = station;
  if (!options_.profile.model.empty()) config["model"] = options_.profile.model;
  const bool listens = endpoint_.capabilities().real_device && !options_.client_cases.empty();
  if (listens) config["role"] = "client";
  if (Status begun = endpoint_.begin(config); !begun) return begun;
  if (listens) {
    const Result<bool> asked = wait_for_request();
    port_failed_ = !asked;
    if (!asked) return asked.error();
    return *asked ? ok() : Status(fail(why_nothing_is_asked({&endpoint_, &protocol_, station})));
  }
  const Result<exchange::Sign> sign = exchange_.anything_answers(station, start_patience);
  port_failed_ = !sign;
  if (!sign) return sign.error();
  answers_ = *sign == exchange::Sign::alive;
  return answers_ ? ok() : Status(fail(why_silent({&endpoint_, &protocol_, station}, *sign)));
}

/// A program is told that the case is over. What it asked last is given up before the next one
/// begins: `waits` for an answer, or the clocks of a stimulus, which stop with their case.
Status Bench::end_asking(const PreparedCase& prepared, bool waits) {
  if (!endpoint_.capabilities().real_device || !prepared.is_client()) return ok();
  const Result<bool> stopped = arming_.end();
  if (!stopped) return stopped.error();
  if (!*stopped || !(waits || prepared.runs_by_clock())) return ok();
  return exchange_.settle(std::max(prepared.client_time_out(), arming_.time_out()) + 100ms);
}

/// The program under test has ended in the middle of a case that waits for its requests. It is
/// started again, so that the others are judged.
bool Bench::gave_up(const PreparedCase& prepared, const Error& trouble, CaseResult& result) {
  if (!prepared.is_client() || !options_.endpoint_is_stimulus || trouble.interrupted) return false;
  result.verdict = Verdict::fail;
  result.message = "the client gave up: " + trouble.message;
  client_gave_up_ = true;
  if (!arming_.revive()) stop("the client gave up too often, last in " + result.id);
  return true;
}

/// The first case that can run shows whether the device asks at all. True as well where none can:
/// each says why.
Result<bool> Bench::wait_for_request() {
  arming_.greet();
  for (const Case* one : options_.client_cases) {
    if (outside_profile(*one).verdict != Verdict::pass) continue;
    const Result<PreparedCase> prepared =
        exchange::prepare(*one, options_.station, protocol_, {options_.known, options_.aux});
    if (!prepared || !prepared->expects_requests() ||
        blocked(*one, *prepared).verdict != Verdict::pass ||
        below_floor(*prepared).verdict != Verdict::pass)
      continue;
    CaseResult given;
    arming_.next_is_probe();
    const bool begun = save_memory(*prepared, given) && begin_case(*prepared, given);
    const Result<bool> asked = begun ? exchange_.anything_is_asked(*prepared, start_patience)
                                     : Result<bool>(fail(given.message));
    // One that gives up is judged, case by case.
    const bool ended = !asked && !asked.error().interrupted &&
                       (client_gave_up_ || (arming_.declares() && arming_.gave_up()));
    if (ended && (arming_.revive() || client_gave_up_)) return true;
    if (!asked) return asked.error();
    if (const Status over = end_asking(*prepared, true); !over) return over.error();
    [[maybe_unused]] const std::string problem =
        saved_for(*prepared).restore();  // told at the end, where it lasts
    return asked;
  }
  return true;
}

Result<std::optional<AdapterFloor>> Bench::measure_floor() {
  if (endpoint_.capabilities().simulated || !answers_) return std::optional<AdapterFloor>();
  Result<results::ResponseTimes> times =
      exchange_.time_probes(options_.station, floor_probes, floor_budget);
  if (!times) return times.error();
  return std::optional(AdapterFloor{AdapterFloor::Source::device, {}, std::move(*times)});
}

Result<Fingerprint> Bench::fingerprint() {
  if (Status alive = start(); !alive) return alive.error();
  return read_fingerprint(endpoint_, protocol_, options_.station, options_.profile.response_max);
}

Result<PreparedCase> Bench::prepare(const Case& source) const {
  return exchange::prepare(source, station_for(source), protocol_, {options_.known, options_.aux});
}

int Bench::station_for(const Case& source) const {
  if (endpoint_.capabilities().real_device) return options_.station;
  return vectors::config_station(source.config, options_.station).value_or(options_.station);
}

json Bench::device_config(const Case& source) const {
  json config = source.config;
  config["station"] = station_for(source);
  if (!options_.profile.model.empty())
    config["model"] = options_.profile.model;
  else
    config["model"] = source.models.empty() ? protocol_.models().front() : source.models.front();
  return config;
}

Bench::Eligibility Bench::outside_profile(const Case& source) const {
  const Profile& profile = options_.profile;
  if (std::ranges::find(profile.protocols, source.protocol) == profile.protocols.end())
    return {Verdict::skip,
            fmt::format("{} is no protocol of the profile {}", source.protocol, profile.name)};
  if (source.protocol != protocol_.name())
    return {Verdict::skip, fmt::format("{} is not what this endpoint speaks ({})", source.protocol,
                                       protocol_.name())};
  if (!profile.model.empty() && !source.models.empty() &&
      std::ranges::find(source.models, profile.model) == source.models.end())
    return {Verdict::skip, fmt::format("for {}; the profile declares {}",
                                       fmt::join(source.models, ", "), profile.model)};
  for (const auto& [pattern, reason] : profile.exclude)
    if (vectors::matches_filter(source.id, pattern))
      return {Verdict::skip, "excluded by the profile: " + reason};
  return {};
}

/// On hardware the configuration of a case must be what is declared.
std::string Bench::undeclared(const json& config) const {
  const bool asks = config.value("role", "server") == "client";
  for (const auto& [key, value] : config.items()) {
    if (key == "station" || key == "p2p" || (key == "role" && asks)) continue;  // Arming tells
    if (asks && arming_.tells(key)) continue;
    const json& declared = options_.profile.config;
    const json fallback = default_config().value(key, json());
    const json has = declared.value(key, fallback);
    if (!has.is_null() && plain(has) == plain(value)) continue;
    return fmt::format("needs {} = {}; the profile declares {}{}", key, plain(value),
                       has.is_null() ? "nothing" : plain(has), asks ? arming_.not_told(key) : "");
  }
  return {};
}

/// What the bench sends to a client are answers; what it sets goes over the second channel. An
/// error: it cannot be set.
Result<std::vector<Protocol::Written>> Bench::written_over_aux(const PreparedCase& prepared) const {
  std::vector<Protocol::Written> written;
  const exchange::Channel& aux = options_.aux;
  if (!aux.endpoint) return written;
  std::vector<std::pair<std::string, std::string>> memory = prepared.source->memory;
  for (const nlohmann::json& block : exchange::p2p_blocks(prepared.source->config))
    if (!exchange::flag_of(block).empty() && !exchange::runs_by_clock(block))
      memory.emplace_back(exchange::flag_of(block), "00");
  for (const exchange::PreparedStep& step : prepared.steps)
    if (step.step->kind == vectors::Step::Kind::set)
      memory.insert(memory.end(), step.step->memory.begin(), step.step->memory.end());
  for (const auto& [address, hex] : memory) {
    const Result<std::vector<Bytes>> requests =
        aux.protocol->write_requests(aux.station, address, hex);
    if (!requests)
      return fail(fmt::format("cannot set {} over --aux: {}", address, requests.error().message));
    for (const Bytes& request : *requests)
      std::ranges::move(aux.protocol->written_by(request), std::back_inserter(written));
  }
  return written;
}

std::string Bench::fence_objection(const PreparedCase& prepared) const {
  if (prepared.is_client()) {
    const Result<std::vector<Protocol::Written>> written = written_over_aux(prepared);
    if (!written) return written.error().message;
    return written->empty() ? "" : options_.fence.objection(*written, *options_.aux.protocol);
  }
  const auto unsettable =
      [&](const std::vector<std::pair<std::string, std::string>>& memory) -> std::string {
    for (const auto& [address, hex] : memory)
      if (const Result<std::vector<Bytes>> requests =
              protocol_.write_requests(prepared.station, address, hex);
          !requests)
        return fmt::format("cannot set {}: {}", address, requests.error().message);
    return {};
  };
  if (std::string why = unsettable(prepared.source->memory); !why.empty()) return why;
  for (const exchange::PreparedStep& step : prepared.steps)
    if (step.step->kind == vectors::Step::Kind::set)
      if (std::string why = unsettable(step.step->memory); !why.empty()) return why;
  return options_.fence.objection(written_by(prepared), protocol_);
}

/// In the order of the case.
std::vector<Protocol::Written> Bench::written_by(const PreparedCase& prepared) const {
  if (prepared.is_client()) return *written_over_aux(prepared);  // the fence has let it pass
  std::vector<Protocol::Written> written;
  const auto add = [&](ByteView request, const Protocol& protocol) {
    std::ranges::move(protocol.written_by(request), std::back_inserter(written));
  };
  const auto add_memory = [&](const std::vector<std::pair<std::string, std::string>>& memory) {
    for (const auto& [address, hex] : memory)
      if (const Result<std::vector<Bytes>> requests =
              protocol_.write_requests(prepared.station, address, hex);
          requests)
        for (const Bytes& request : *requests) add(request, protocol_);
  };
  add_memory(prepared.source->memory);
  for (const exchange::PreparedStep& step : prepared.steps) {
    if (step.step->kind == vectors::Step::Kind::set) add_memory(step.step->memory);
    if (step.step->kind == vectors::Step::Kind::send)
      add(step.frames.front().frame.bytes, *step.protocol);
  }
  return written;
}

Bench::Eligibility Bench::blocked(const Case& source, const PreparedCase& prepared) const {
  const endpoints::Capabilities& can = endpoint_.capabilities();
  if (!can.real_device) return {};
  if (prepared.is_client()) {
    if (std::string why = arming_.undeclared(source, options_.profile.config); !why.empty())
      return {Verdict::skip, why};
    if (std::string why = arming_.objection(source, device_config(source)); !why.empty())
      return {arming_.declares() ? Verdict::skip : Verdict::blocked, why};
  } else if (!source.transpose &&
             vectors::config_station(source.config, options_.station) != options_.station)
    return {Verdict::blocked,
            fmt::format("is about station {}; the device is station {}",
                        *vectors::config_station(source.config, 1), options_.station)};
  if (std::string why = undeclared(source.config); !why.empty())
    return {prepared.is_client() && arming_.declares() ? Verdict::skip : Verdict::blocked, why};
  if (prepared.looks_at_counters() && !prepared.is_client())
    return {Verdict::blocked,
            "looks at the status counters, which no command reads; see XG5000, status by service"};
  if (source.fresh && !can.can_power_cycle && options_.power_cycle_command.empty())
    return {Verdict::blocked, "needs a device fresh from power-on; give --power-cycle COMMAND"};
  return {};
}

Bench::Eligibility Bench::below_floor(const PreparedCase& prepared) const {
  const endpoints::Capabilities& can = endpoint_.capabilities();
  if (can.wire) return {};
  const json& config = prepared.source->config;
  if (config.contains("line") || config.contains("bench_line"))
    return {Verdict::inconclusive,
            "is about speed and character format, which a pty or socket does not carry"};
  // On a network a pause may be longer than it is written: it only sees that a segment has come.
  if (protocol_.default_port() != 0) return {};
  const Duration pause = prepared.shortest_pause(endpoint_.character_time());
  if (pause > 0ns && pause < shortest_judged)
    return {
        Verdict::inconclusive,
        fmt::format(
            "needs a time of {:.1f} ms; below {:.0f} ms nothing is certain behind a pty or socket",
            to_ms(pause), to_ms(shortest_judged))};
  return {};
}

/// Whatever can be settled before a byte is sent.
Bench::Ready Bench::make_ready(const Case& source) const {
  Ready ready;
  const auto declined = [&](Eligibility why) {
    ready.why = std::move(why);
    return std::move(ready);
  };
  if (const Eligibility outside = outside_profile(source); outside.verdict != Verdict::pass)
    return declined(outside);
  Result<PreparedCase> prepared = prepare(source);
  if (!prepared) return declined({Verdict::error, prepared.error().message});
  if (const Eligibility why = blocked(source, *prepared); why.verdict != Verdict::pass)
    return declined(why);
  // Memory is asked for where a real device declares it to lie, and written only where it is
  // allowed.
  const bool real = endpoint_.capabilities().real_device;
  if (real && !prepared->is_client()) {
    Result<std::optional<Case>> placed = safety::placed_case(*prepared, protocol_);
    if (!placed) return declined({Verdict::blocked, placed.error().message});
    if (*placed) ready.elsewhere = std::make_unique<Case>(std::move(**placed));
    const Case& here = ready.elsewhere ? *ready.elsewhere : source;
    const Result<std::vector<results::Move>> planned =
        safety::plan_moves(here, station_for(source), options_.fence, protocol_);
    if (!planned) return declined({Verdict::blocked, planned.error().message});
    ready.moves = *planned;
    if (!ready.moves.empty()) {
      Result<Case> moved = safety::moved_case(here, station_for(source), ready.moves, protocol_);
      if (!moved) return declined({Verdict::blocked, moved.error().message});
      ready.elsewhere = std::make_unique<Case>(std::move(*moved));
    }
  }
  if (ready.elsewhere) {
    prepared = prepare(*ready.elsewhere);
    if (!prepared) return declined({Verdict::error, prepared.error().message});
  }
  if (std::string why = real ? fence_objection(*prepared) : ""; !why.empty())
    return declined({Verdict::blocked, why});
  if (const Eligibility why = below_floor(*prepared); why.verdict != Verdict::pass)
    return declined(why);
  ready.prepared = std::move(*prepared);
  return ready;
}

bool Bench::could_run(const Case& source) const { return make_ready(source).prepared.has_value(); }

std::vector<Protocol::Written> Bench::written_by(const Case& source) const {
  const Result<PreparedCase> prepared = prepare(source);
  if (!prepared || prepared->is_client()) return {};
  return written_by(*prepared);
}

CaseResult Bench::run(const Case& source) {
  CaseResult result = judging::result_of(source);
  result.replay = options_.replay + "'" + source.id + "'";
  const auto decline = [&](const Eligibility& why) {
    result.verdict = why.verdict;
    result.message = why.reason;
    return result;
  };
  if (vectors::is_client_case(source) && endpoint_.capabilities().real_device) arming_.greet();
  const Ready ready = make_ready(source);
  if (!ready.prepared) return decline(ready.why);
  if (!stopped_.empty()) return decline({Verdict::blocked, stopped_});
  for (const results::Move& move : ready.moves)
    result.notes.push_back(safety::note_of(move, protocol_));
  set_up_answered_ = true;
  execute(*ready.prepared, result);
  if (port_failed_ && !interrupted_) start_again(result);
  set_up_findings_.note(result);
  if (endpoint_.capabilities().real_device && !ready.prepared->is_client() && stopped_.empty())
    stopped_ = worth_asking_.after(result, protocol_, set_up_answered_);
  if (!result.recording.stimulus.empty()) result.recording.moves = ready.moves;
  errors_in_a_row_ = result.verdict == Verdict::error ? errors_in_a_row_ + 1 : 0;
  if (errors_in_a_row_ == errors_to_stop && stopped_.empty())
    stop(fmt::format("{} errors in a row: {}", errors_to_stop, result.message));
  return result;
}

void Bench::execute(const PreparedCase& prepared, CaseResult& result) {
  judging::note_transposition(prepared, result);
  const bool real = endpoint_.capabilities().real_device;
  if (real && !save_memory(prepared, result)) return;
  if (prepare_device(prepared, result)) exchange(prepared, result);
  if (!real) return;
  if (const std::string problem = saved_for(prepared).restore(); !problem.empty())
    result.notes.push_back("not put back what it wrote: " + problem);
}

void Bench::exchange(const PreparedCase& prepared, CaseResult& result) {
  exchange::Transcript transcript = exchange_.run(prepared);
  if (!transcript.trouble)
    if (const Status over = end_asking(prepared, exchange::leaves_open(transcript)); !over)
      transcript.trouble = over.error();
  judge_exchange(prepared, transcript, result);
  after(prepared, transcript, result);
  readings_.note(result);
}

bool Bench::save_memory(const PreparedCase& prepared, CaseResult& result) {
  const std::vector<Protocol::Written> written = written_by(prepared);
  if (std::ranges::any_of(written, &Protocol::Written::unknown))
    result.notes.push_back(
        "not saved before: nobody can tell where a damaged write request would write");
  safety::SavedMemory& memory = saved_for(prepared);
  const Status saved = memory.save(written);
  set_up_answered_ = !memory.unserved();
  if (saved && memory.damaged() > 0 && writes_without_check(prepared)) {
    result.verdict = Verdict::blocked;
    result.message = fmt::format(
        "the line has damaged {} answers to what the bench reads before it writes; this case "
        "writes by a request without a check, which could write elsewhere when it is damaged, too. "
        "Mend the line (cable, termination, ground, speed)",
        memory.damaged());
    return false;
  }
  if (saved) return true;
  // A device that the bench starts itself forgets all with its process: there the case may name the
  // fault.
  if (endpoint_.capabilities().can_power_cycle && !memory.port_failed() && !prepared.is_client() &&
      options_.journal) {
    result.notes.push_back(saved.error().message);
    return !memory.silent() || look_for_device(result, saved.error().message);
  }
  result.verdict = memory.port_failed() ? Verdict::error : Verdict::blocked;
  result.message = (prepared.is_client() ? "--aux: " : "") + saved.error().message;
  if (memory.port_failed())
    stop("the port failed before " + result.id + ": " + result.message, &saved.error());
  else if (memory.silent())
    prepared.is_client() ? stop(result.message)
                         : void(look_for_device(result, saved.error().message));
  return false;
}

/// On a line; a network has its own checks.
bool Bench::writes_without_check(const PreparedCase& prepared) const {
  if (protocol_.default_port() != 0 || !protocol_.memory() || prepared.is_client()) return false;
  return std::ranges::any_of(prepared.steps, [&](const exchange::PreparedStep& step) {
    if (step.step->kind != vectors::Step::Kind::send) return false;
    const Bytes& request = step.frames.front().frame.bytes;
    return !protocol_.written_by(request).empty() && !protocol_.memory()->is_checked(request);
  });
}

std::string Bench::put_back() {
  if (!endpoint_.capabilities().real_device) return {};
  std::string open;
  for (safety::SavedMemory* memory : {&saved_, &saved_over_aux_}) {
    [[maybe_unused]] const std::string problem = memory->restore();
    if (const std::string places = memory->open_places(); !places.empty())
      open += (open.empty() ? "" : ", ") + places;
  }
  return open;
}

bool Bench::prepare_device(const PreparedCase& prepared, CaseResult& result) {
  const bool real = endpoint_.capabilities().real_device;
  const auto give_up = [&](Verdict verdict, const Error& error) {
    result.verdict = verdict;
    result.message = error.message;
    if (error.interrupted)
      stop("interrupted", &error);
    else if (real && verdict == Verdict::error)
      stop("the port failed in " + result.id + ": " + error.message, &error);
    return false;
  };
  if (Status begun = endpoint_.begin(device_config(*prepared.source)); !begun)
    return give_up(Verdict::error, begun.error());
  if (prepared.source->fresh && real && !power_cycle(result, prepared.is_client()))
    return give_up(Verdict::blocked, fail("the device did not come back from the power cycle"));
  // What a clock asked between the cases is no part of this one. It waits for its answer before it
  // asks again.
  if (real && prepared.runs_by_clock())
    if (Status quiet = exchange_.settle(50ms); !quiet)
      return give_up(Verdict::error, quiet.error());
  if (begin_case(prepared, result)) return true;
  if (!real || prepared.is_client() || interrupted_) return false;
  if (!memory_.refused()) return give_up(Verdict::error, Error{result.message});
  if (memory_.silent()) look_for_device(result, result.message);
  return false;
}

/// Sets the given memory; whatever makes a real client ask is told of the case.
bool Bench::begin_case(const PreparedCase& prepared, CaseResult& result) {
  const auto give_up = [&](Verdict verdict, const Error& error) {
    result.verdict = verdict;
    result.message = error.message;
    if (error.interrupted) stop("interrupted", &error);
    return false;
  };
  const auto set = [&](const std::string& address, const std::string& hex) {
    const Status done = memory_.set(prepared, address, hex);
    if (done)
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
    if (const Status begun = arming_.begin(*prepared.source, device_config(*prepared.source));
        !begun)
      return give_up(arming_.gave_up() ? Verdict::fail : Verdict::error, begun.error());
    // A flag that an earlier case left on would have no rising edge.
    if (arming_.aux())
      for (const std::string& flag : arming_.flags())
        if (const Status reset = set(flag, "00"); !reset)
          return give_up(Verdict::error, reset.error());
  }
  for (const auto& [address, hex] : prepared.source->memory) {
    const Status done = set(address, hex);
    if (done) continue;
    if (!memory_.refused())
      return give_up(arming_.gave_up() ? Verdict::fail : Verdict::error, done.error());
    const Time now = endpoint_.now();
    result.exchange.push_back({results::Event::Kind::note, now, now, {}, memory_.said()});
    set_up_answered_ = !memory_.unserved();
    return give_up(Verdict::blocked,
                   Error{std::string(exchange::set_up_failure) + done.error().message});
  }
  return true;
}

void Bench::judge_exchange(const PreparedCase& prepared, const exchange::Transcript& transcript,
                           CaseResult& result) {
  judging::take_judgement(judging::judge(prepared, transcript, rules(), protocol_), result);
  result.recording = judging::make_recording(prepared, transcript, rules());
  for (results::Event event : transcript.events) {
    if (event.kind == results::Event::Kind::sent || event.kind == results::Event::Kind::received)
      event.text = notation::print_bytes(event.bytes);
    result.exchange.push_back(std::move(event));
  }
  if (const std::string errors = endpoint_.line_errors(); !errors.empty())
    result.notes.push_back("the driver counted " + errors);
}

void Bench::after(const PreparedCase& prepared, const exchange::Transcript& transcript,
                  CaseResult& result) {
  if (transcript.trouble && gave_up(prepared, *transcript.trouble, result)) return;
  if (transcript.trouble)
    return stop("the port failed in " + result.id + ": " + transcript.trouble->message,
                &*transcript.trouble);
  bool dead = !transcript.dead.empty();
  // In simulated time the sanity exchange after a negative case is made here; in real time closing
  // the case was one.
  const bool negative = prepared.listens_for_silence() || result.verdict == Verdict::fail;
  if (endpoint_.capabilities().simulated && negative && prepared.answers_probes()) {
    const Result<exchange::Sign> alive = exchange_.anything_answers(
        prepared.station, 3 * options_.profile.response_max, prepared.reply_delay());
    if (!alive)
      return stop("the port failed after " + result.id + ": " + alive.error().message,
                  &alive.error());
    dead = *alive != exchange::Sign::alive;
    if (dead) result.recording.dead = "nothing answers any more";
    if (dead && result.verdict != Verdict::fail) {
      result.verdict = Verdict::fail;
      result.message = "link dead after this frame: nothing answers any more";
    }
  }
  // Emulators become a fresh device with the next case.
  if (dead && endpoint_.capabilities().real_device) revive(result);
}

/// It did not answer when its memory was read or set for a case: does it still answer anything? If
/// not, the case says so after `what`.
bool Bench::look_for_device(CaseResult& result, const std::string& what) {
  const Result<exchange::Sign> alive =
      exchange_.anything_answers(options_.station, 3 * options_.profile.response_max);
  if (!alive) {
    result.verdict = Verdict::error;
    result.message = alive.error().message;
    stop("the port failed in " + result.id + ": " + result.message, &alive.error());
    return false;
  }
  if (*alive == exchange::Sign::alive) return true;
  result.verdict = Verdict::fail;
  result.message = what + "; nothing answers any more";
  revive(result);
  return false;
}

/// A device that the bench has started itself, and whose process has ended.
void Bench::start_again(CaseResult& result) {
  if (!endpoint_.capabilities().real_device || !endpoint_.capabilities().can_power_cycle ||
      !options_.power_cycle_command.empty() || options_.endpoint_is_stimulus ||
      options_.max_restarts == 0)
    return;
  const auto last = std::ranges::find(result.exchange.rbegin(), result.exchange.rend(),
                                      results::Event::Kind::sent, &results::Event::kind);
  const std::string frame = last == result.exchange.rend()
                                ? "in the set-up"
                                : "after " + notation::print_bytes(last->bytes);
  result.message = fmt::format("the device ended {}: {}", frame, stopped_);
  result.verdict = Verdict::fail;
  stopped_.clear();
  port_failed_ = false;
  revive(result);
}

void Bench::revive(CaseResult& result) {
  if (endpoint_.capabilities().can_power_cycle && options_.power_cycle_command.empty())
    if (std::string enough = worth_asking_.restart(result); !enough.empty())
      return stop(std::move(enough));
  if (!power_cycle(result))
    stop(fmt::format(
        "the link is dead since {}; power-cycle the device, or give --power-cycle COMMAND",
        result.id));
}

bool Bench::power_cycle(CaseResult& result, bool client) {
  const bool hook = !options_.power_cycle_command.empty();
  if (hook && !os::run_hook(options_.power_cycle_command, {}, {})) {
    result.notes.push_back("the --power-cycle command failed");
    return false;
  }
  if (!hook && (!endpoint_.capabilities().can_power_cycle || !endpoint_.act("power_cycle")))
    return false;
  result.notes.push_back("power-cycled the device");
  if (client) return arming_.started_anew();  // it answers no probe
  const Result<exchange::Sign> sign =
      exchange_.anything_answers(options_.station, revive_patience, {}, true);
  return sign && *sign == exchange::Sign::alive;
}

void Bench::stop(std::string why, const Error* error) {
  stopped_ = std::move(why);
  port_failed_ = error != nullptr;
  interrupted_ = error && error->interrupted;
}

}  // namespace fieldproof::bench
