#include "reports/results/case_result.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

namespace fieldproof::results {
namespace {

using nlohmann::json;

[[noreturn]] void refuse(const std::string& message, const json& context) {
  throw json::other_error::create(501, message, &context);
}

/// Empty fields are left out: most cases pass, and a long run stays readable.
template <typename T>
void put(json& object, const char* key, const T& value) {
  if (!value.empty()) object[key] = value;
}

template <typename T>
void get(const json& object, const char* key, T& value) {
  if (auto found = object.find(key); found != object.end()) found->get_to(value);
}

void put_bytes(json& object, const char* key, const Bytes& bytes) {
  if (!bytes.empty()) object[key] = to_hex(bytes);
}

void get_bytes(const json& object, const char* key, Bytes& bytes) {
  std::string text;
  get(object, key, text);
  auto parsed = from_hex(text);
  if (!parsed) refuse("'" + std::string(key) + "' is not hex", object);
  bytes = std::move(*parsed);
}

void get_time(const json& object, const char* key, Time& time) {
  double ms = to_ms(time);
  get(object, key, ms);
  if (!(std::abs(ms) < 9e12)) refuse("'" + std::string(key) + "' is not a time of a run", object);
  time = Time(std::llround(ms * 1e6));
}

const char* kind_word(Event::Kind kind) {
  switch (kind) {
    case Event::Kind::sent: return "sent";
    case Event::Kind::received: return "received";
    case Event::Kind::opened: return "opened";
    case Event::Kind::closed: return "closed";
    case Event::Kind::reset: return "reset";
    case Event::Kind::note: break;
  }
  return "note";
}

Event::Kind parse_kind(const json& object) {
  const auto word = object.at("kind").get<std::string>();
  for (Event::Kind kind : {Event::Kind::sent, Event::Kind::received, Event::Kind::note,
                           Event::Kind::opened, Event::Kind::closed, Event::Kind::reset}) {
    if (word == kind_word(kind)) return kind;
  }
  refuse("unknown kind of event '" + word + "'", object);
}

}  // namespace

Identity in_common(Identity a, const Identity& b) {
  for (std::string Identity::*field :
       {&Identity::name, &Identity::maker, &Identity::model, &Identity::serial, &Identity::firmware,
        &Identity::operator_name, &Identity::notes})
    if (a.*field != b.*field) (a.*field).clear();
  if (a.fingerprint != b.fingerprint) a.fingerprint.clear();
  if (a.fingerprint_found != b.fingerprint_found) a.fingerprint_found.clear();
  return a;
}

void to_json(json& object, const Event& event) {
  object = {{"kind", kind_word(event.kind)},
            {"start_ms", to_ms(event.start)},
            {"end_ms", to_ms(event.end)}};
  put_bytes(object, "hex", event.bytes);
  put(object, "text", event.text);
  if (event.step >= 0) object["step"] = event.step;
  if (event.surplus) object["surplus"] = true;
  put(object, "link", event.link);
  if (event.port != 0) object["port"] = event.port;
  if (event.transport == Transport::udp) object["transport"] = "udp";
  if (event.by_device) object["by_device"] = true;
}

void from_json(const json& object, Event& event) {
  event = {};
  event.kind = parse_kind(object);
  get_time(object, "start_ms", event.start);
  get_time(object, "end_ms", event.end);
  get_bytes(object, "hex", event.bytes);
  get(object, "text", event.text);
  get(object, "step", event.step);
  get(object, "surplus", event.surplus);
  get(object, "link", event.link);
  get(object, "port", event.port);
  if (object.value("transport", "tcp") == "udp") event.transport = Transport::udp;
  get(object, "by_device", event.by_device);
}

void to_json(json& object, const StepOutcome& step) {
  object = json::object();
  if (step.stimulus != Time{}) object["stimulus_ms"] = to_ms(step.stimulus);
  put(object, "memory", step.memory);
  put(object, "refused", step.refused);
  if (step.refused_by_device) object["refused_by_device"] = true;
}

void from_json(const json& object, StepOutcome& step) {
  step = {};
  get_time(object, "stimulus_ms", step.stimulus);
  get(object, "memory", step.memory);
  get(object, "refused", step.refused);
  get(object, "refused_by_device", step.refused_by_device);
}

void to_json(json& object, const Move& move) {
  object = {{"area", move.area}, {"first", move.first}, {"last", move.last}, {"words", move.words}};
}

void from_json(const json& object, Move& move) {
  object.at("area").get_to(move.area);
  object.at("first").get_to(move.first);
  object.at("last").get_to(move.last);
  object.at("words").get_to(move.words);
}

void to_json(json& object, const Recording& recording) {
  object = {{"stimulus", recording.stimulus},
            {"station", recording.station},
            {"steps", recording.steps},
            {"timing_floor_ms", to_ms(recording.timing_floor)},
            {"link_floor_ms", to_ms(recording.link_floor)},
            {"max_gap_ms", to_ms(recording.max_gap)}};
  if (recording.flooded) object["flooded"] = true;
  if (recording.period_tolerance > 0ns)
    object["period_tolerance_ms"] = to_ms(recording.period_tolerance);
  put(object, "dead", recording.dead);
  put(object, "moves", recording.moves);
}

void from_json(const json& object, Recording& recording) {
  recording = {};
  object.at("stimulus").get_to(recording.stimulus);
  get(object, "station", recording.station);
  get(object, "moves", recording.moves);
  get(object, "steps", recording.steps);
  get(object, "flooded", recording.flooded);
  get(object, "dead", recording.dead);
  get_time(object, "timing_floor_ms", recording.timing_floor);
  recording.link_floor = recording.timing_floor;  // older files have one floor
  get_time(object, "link_floor_ms", recording.link_floor);
  get_time(object, "max_gap_ms", recording.max_gap);
  get_time(object, "period_tolerance_ms", recording.period_tolerance);
}

void to_json(json& object, const Difference& difference) {
  object = {{"field", difference.field},
            {"expected", difference.expected},
            {"received", difference.received}};
  put(object, "hint", difference.hint);
}

void from_json(const json& object, Difference& difference) {
  difference = {};
  object.at("field").get_to(difference.field);
  get(object, "expected", difference.expected);
  get(object, "received", difference.received);
  get(object, "hint", difference.hint);
}

void to_json(json& object, const CaseResult& result) {
  object = {{"id", result.id},
            {"rev", result.rev},
            {"protocol", result.protocol},
            {"title", result.title},
            {"level", result.level},
            {"basis", result.basis},
            {"verdict", to_string(result.verdict)},
            {"seconds", result.seconds}};
  put(object, "line", result.line);
  if (result.repeat != 0) object["repeat"] = result.repeat;
  put(object, "dut", result.dut);
  put(object, "manual", result.manual);
  put(object, "section", result.section);
  put(object, "quote", result.quote);
  put(object, "message", result.message);
  put(object, "notes", result.notes);
  put(object, "expected", result.expected);
  put_bytes(object, "expected_bytes", result.expected_bytes);
  put(object, "expected_hex", result.expected_hex);
  put(object, "received", result.received);
  put_bytes(object, "received_bytes", result.received_bytes);
  put(object, "differences", result.differences);
  put(object, "exchange", result.exchange);
  if (!result.recording.stimulus.empty()) object["recording"] = result.recording;
  put(object, "readings", result.readings);
  put(object, "response_ms", result.response_ms);
  put(object, "replay", result.replay);
}

void from_json(const json& object, CaseResult& result) {
  result = {};
  object.at("id").get_to(result.id);
  const auto word = object.at("verdict").get<std::string>();
  const auto verdict = parse_verdict(word);
  if (!verdict) refuse("unknown verdict '" + word + "'", object);
  result.verdict = *verdict;
  get(object, "line", result.line);
  get(object, "repeat", result.repeat);
  get(object, "dut", result.dut);
  get(object, "rev", result.rev);
  get(object, "protocol", result.protocol);
  get(object, "title", result.title);
  get(object, "level", result.level);
  get(object, "basis", result.basis);
  get(object, "manual", result.manual);
  get(object, "section", result.section);
  get(object, "quote", result.quote);
  get(object, "message", result.message);
  get(object, "notes", result.notes);
  get(object, "expected", result.expected);
  get_bytes(object, "expected_bytes", result.expected_bytes);
  get(object, "expected_hex", result.expected_hex);
  get(object, "received", result.received);
  get_bytes(object, "received_bytes", result.received_bytes);
  get(object, "differences", result.differences);
  get(object, "exchange", result.exchange);
  get(object, "recording", result.recording);
  get(object, "readings", result.readings);
  get(object, "response_ms", result.response_ms);
  get(object, "seconds", result.seconds);
  get(object, "replay", result.replay);
}

void to_json(json& object, const Identity& identity) {
  object = json::object();
  put(object, "name", identity.name);
  put(object, "maker", identity.maker);
  put(object, "model", identity.model);
  put(object, "serial", identity.serial);
  put(object, "firmware", identity.firmware);
  put(object, "operator", identity.operator_name);
  put(object, "notes", identity.notes);
  put(object, "fingerprint", identity.fingerprint);
  put(object, "fingerprint_found", identity.fingerprint_found);
}

void from_json(const json& object, Identity& identity) {
  identity = {};
  get(object, "name", identity.name);
  get(object, "maker", identity.maker);
  get(object, "model", identity.model);
  get(object, "serial", identity.serial);
  get(object, "firmware", identity.firmware);
  get(object, "operator", identity.operator_name);
  get(object, "notes", identity.notes);
  get(object, "fingerprint", identity.fingerprint);
  get(object, "fingerprint_found", identity.fingerprint_found);
}

void to_json(json& object, const DutInfo& dut) {
  object = {{"endpoint", dut.endpoint}, {"identity", dut.identity}};
  put(object, "properties", dut.properties);
}

void from_json(const json& object, DutInfo& dut) {
  dut = {};
  object.at("endpoint").get_to(dut.endpoint);
  get(object, "identity", dut.identity);
  get(object, "properties", dut.properties);
}

void to_json(json& object, const ErratumInfo& erratum) {
  object = {{"vector", erratum.vector_id}, {"manual", erratum.manual},
            {"section", erratum.section},  {"printed", erratum.printed},
            {"correct", erratum.correct},  {"why", erratum.why}};
}

void from_json(const json& object, ErratumInfo& erratum) {
  erratum = {};
  object.at("vector").get_to(erratum.vector_id);
  get(object, "manual", erratum.manual);
  get(object, "section", erratum.section);
  get(object, "printed", erratum.printed);
  get(object, "correct", erratum.correct);
  get(object, "why", erratum.why);
}

void to_json(json& object, const RunInfo& info) {
  object = {{"tool_version", info.tool_version}, {"started", info.started},
            {"endpoint", info.endpoint},         {"profile", info.profile},
            {"command", info.command},           {"vectors_hash", info.vectors_hash},
            {"properties", info.properties}};
  if (json identity = info.identity; !identity.empty()) object["identity"] = std::move(identity);
  put(object, "hashes", info.hashes);
  put(object, "errata", info.errata);
  put(object, "duts", info.duts);
}

void from_json(const json& object, RunInfo& info) {
  info = {};
  object.at("tool_version").get_to(info.tool_version);
  object.at("started").get_to(info.started);
  get(object, "endpoint", info.endpoint);
  get(object, "profile", info.profile);
  get(object, "command", info.command);
  get(object, "vectors_hash", info.vectors_hash);
  get(object, "properties", info.properties);
  get(object, "identity", info.identity);
  get(object, "hashes", info.hashes);
  get(object, "errata", info.errata);
  get(object, "duts", info.duts);
}

void to_json(json& object, const RunEnd& end) {
  object = {{"finished", end.finished},
            {"seconds", end.seconds},
            {"exit_code", end.exit_code},
            {"interrupted", end.interrupted}};
  put(object, "trouble", end.trouble);
}

void from_json(const json& object, RunEnd& end) {
  end = {};
  object.at("exit_code").get_to(end.exit_code);
  get(object, "finished", end.finished);
  get(object, "seconds", end.seconds);
  get(object, "interrupted", end.interrupted);
  get(object, "trouble", end.trouble);
}

}  // namespace fieldproof::results
