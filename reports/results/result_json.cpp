#include "reports/results/result_json.hpp"

#include "reports/results/json_fields.hpp"

// ---- words

namespace fieldproof {

static std::string_view to_string(Transport transport) {
  return transport == Transport::udp ? "udp" : "tcp";
}

static void from_word(std::string_view word, Transport& transport) {
  if (word != "tcp" && word != "udp") results::refuse(fmt::format("unknown transport '{}'", word));
  transport = word == "udp" ? Transport::udp : Transport::tcp;
}

// ---- fields of a trace

using results::Of;

void fields(auto& json, Of<AxisTrace::Sample> auto& sample) {
  json.must("ms", sample.time);
  json.must("position", sample.position);
  json.must("speed", sample.speed);
}

void fields(auto& json, Of<AxisTrace::Event> auto& event) {
  json.must("ms", event.time);
  json.must("what", event.what);
}

void fields(auto& json, Of<AxisTrace::Limit> auto& limit) {
  json.must("from", limit.from);
  json.must("name", limit.name);
  json.must("to", limit.to);
}

void fields(auto& json, Of<AxisTrace> auto& axis) {
  json.must("axis", axis.axis);
  json.may("events", axis.events);
  json.may("limits", axis.limits);
  json.must("samples", axis.samples);
}

void fields(auto& json, Of<TokenTurn> auto& turn) {
  json.may("begins", turn.begins);
  json.may("busy_ms", turn.busy);
  json.must("from_ms", turn.from);
  json.may("of", turn.of);
  json.must("station", turn.station);
  json.must("to_ms", turn.to);
}

void fields(auto& json, Of<NetTrace> auto& net) {
  json.may("cycle_ms", net.cycle);
  json.must("net", net.net);
  json.must("turns", net.turns);
}

void fields(auto& json, Of<Trace> auto& trace) {
  json.may("axes", trace.axes);
  json.may("nets", trace.nets);
}

template <typename T>
requires requires(results::FieldReader& reader, T& value) { fields(reader, value); }
void from_json(const nlohmann::json& json, T& value) { results::read_fields(json, value); }

}  // namespace fieldproof

namespace fieldproof::results {

void from_word(std::string_view word, Event::Kind& kind) {
  for (const Event::Kind one : {Event::Kind::sent, Event::Kind::received, Event::Kind::note,
                                Event::Kind::opened, Event::Kind::closed, Event::Kind::reset})
    if (word == to_string(one)) return void(kind = one);
  refuse(fmt::format("unknown kind of event '{}'", word));
}

void from_word(std::string_view word, Verdict& verdict) {
  const std::optional<Verdict> parsed = parse_verdict(word);
  if (!parsed) refuse(fmt::format("unknown verdict '{}'", word));
  verdict = *parsed;
}

// ---- fields of a case

void fields(auto& json, Of<Extract> auto& extract) {
  json.must("count", extract.count);
  json.must("sha256", extract.sha256);
  json.must("tail", extract.tail);
}

void fields(auto& json, Of<Event> auto& event) {
  json.may("by_device", event.by_device);
  json.always("end_ms", event.end);
  json.may("extract", event.extract);
  json.may("hex", event.bytes);
  json.must("kind", event.kind);
  json.may("link", event.link);
  json.may("port", event.port);
  json.always("start_ms", event.start);
  json.may("step", event.step, -1);
  json.may("surplus", event.surplus);
  json.may("text", event.text);
  json.may("transport", event.transport);
}

void fields(auto& json, Of<StepOutcome> auto& step) {
  json.may("memory", step.memory);
  json.may("passed_over", step.passed_over);
  json.may("refused", step.refused);
  json.may("refused_by_device", step.refused_by_device);
  json.may("stimulus_ms", step.stimulus);
}

void fields(auto& json, Of<Move> auto& move) {
  json.must("area", move.area);
  json.must("first", move.first);
  json.must("last", move.last);
  json.must("words", move.words);
}

void fields(auto& json, Of<Recording> auto& recording) {
  json.may("dead", recording.dead);
  json.may("earliest_ms", recording.earliest);
  json.may("flooded", recording.flooded);
  json.may("gap_floor_ms", recording.gap_floor);
  json.always("link_floor_ms", recording.link_floor);
  json.always("max_gap_ms", recording.max_gap);
  json.may("moves", recording.moves);
  json.may("period_tolerance_ms", recording.period_tolerance);
  json.always("station", recording.station);
  json.always("steps", recording.steps);
  json.must("stimulus", recording.stimulus);
  json.always("timing_floor_ms", recording.timing_floor);
  json.otherwise("link_floor_ms", recording.link_floor, recording.timing_floor);
}

void fields(auto& json, Of<Due> auto& due) {
  json.always("from_ms", due.from);
  json.always("until_ms", due.until);
}

void fields(auto& json, Of<Difference> auto& difference) {
  json.always("expected", difference.expected);
  json.must("field", difference.field);
  json.may("hint", difference.hint);
  json.always("received", difference.received);
}

void fields(auto& json, Of<CaseResult> auto& result) {
  json.always("basis", result.basis);
  json.may("differences", result.differences);
  json.may("due", result.due);
  json.may("dut", result.dut);
  json.may("exchange", result.exchange);
  json.may("expected", result.expected);
  json.may("expected_bytes", result.expected_bytes);
  json.may("expected_hex", result.expected_hex);
  json.must("id", result.id);
  json.always("level", result.level);
  json.may("line", result.line);
  json.may("manual", result.manual);
  json.may("message", result.message);
  json.may("notes", result.notes);
  json.may("on_model", result.on_model);
  json.always("protocol", result.protocol);
  json.may("quote", result.quote);
  json.may("readings", result.readings);
  json.may("received", result.received);
  json.may("received_bytes", result.received_bytes);
  json.may("received_extract", result.received_extract);
  json.may("recording", result.recording);
  json.may("repeat", result.repeat);
  json.may("replay", result.replay);
  json.may("response_ms", result.response_ms);
  json.always("rev", result.rev);
  json.always("seconds", result.seconds);
  json.may("section", result.section);
  json.always("title", result.title);
  json.may("trace", result.trace);
  json.must("verdict", result.verdict);
}

// ---- fields of a run

void fields(auto& json, Of<Identity> auto& identity) {
  json.may("fingerprint", identity.fingerprint);
  json.may("fingerprint_found", identity.fingerprint_found);
  json.may("firmware", identity.firmware);
  json.may("maker", identity.maker);
  json.may("model", identity.model);
  json.may("name", identity.name);
  json.may("notes", identity.notes);
  json.may("operator", identity.operator_name);
  json.may("serial", identity.serial);
}

void fields(auto& json, Of<DutInfo> auto& dut) {
  json.must("endpoint", dut.endpoint);
  json.always("identity", dut.identity);
  json.may("properties", dut.properties);
}

void fields(auto& json, Of<Passage> auto& passage) {
  json.must("manual", passage.manual);
  json.always("quote", passage.quote);
  json.must("section", passage.section);
}

void fields(auto& json, Of<ErratumInfo> auto& erratum) {
  json.may("doubt", erratum.doubt);
  json.always("effect", erratum.effect);
  json.always("id", erratum.id);  // not in older files
  json.always("kind", erratum.kind);
  json.always("places", erratum.places);
  json.always("printed", erratum.printed);
  json.always("proof", erratum.proof);
  json.always("right", erratum.right);
  json.may("vectors", erratum.vectors);
  json.always("why", erratum.why);
}

void fields(auto& json, Of<RunInfo> auto& info) {
  json.always("command", info.command);
  json.may("duts", info.duts);
  json.always("endpoint", info.endpoint);
  json.may("errata", info.errata);
  json.may("hashes", info.hashes);
  json.may("identity", info.identity);
  json.always("profile", info.profile);
  json.always("properties", info.properties);
  json.may("sections", info.sections);
  json.must("started", info.started);
  json.must("tool_version", info.tool_version);
  json.always("vectors_hash", info.vectors_hash);
}

void fields(auto& json, Of<Reason> auto& reason) {
  json.must("exit_code", reason.exit_code);
  json.always("message", reason.message);
  json.must("what", reason.what);
}

void fields(auto& json, Of<RunEnd> auto& end) {
  json.must("exit_code", end.exit_code);
  json.always("finished", end.finished);
  json.may("hint", end.hint);
  json.always("interrupted", end.interrupted);
  json.may("reasons", end.reasons);
  json.always("seconds", end.seconds);
  json.may("trouble", end.trouble);
}

// ---- fields of a soak

void fields(auto& json, Of<ResponseFigures> auto& figures) {
  json.must("max_ms", figures.greatest);
  json.must("median_ms", figures.median);
  json.must("min_ms", figures.least);
  json.must("p99_ms", figures.p99);
  json.must("replies", figures.count);
}

void fields(auto& json, Of<SoakSample> auto& sample) {
  json.must("failed", sample.failed);
  json.must("from_s", sample.from_s);
  json.must("judged", sample.judged);
  json.must("response", sample.response);
  json.must("to_s", sample.to_s);
}

void fields(auto& json, Of<SoakCase> auto& one) {
  json.must("counts", one.counts);
  json.must("response", one.response);
}

void fields(auto& json, Of<SoakSummary> auto& soak) {
  json.must("cases", soak.cases);
  json.derived("error_rate", soak.error_rate());
  json.must("failed", soak.failed);
  json.must("first_tenth", soak.first);
  json.must("judged", soak.judged);
  json.must("last_tenth", soak.last);
  json.must("planned_s", soak.planned_s);
  json.must("response", soak.response);
  json.must("rounds", soak.rounds);
  json.must("seconds", soak.seconds);
  json.must("unwritten", soak.unwritten);
}

// ---- both ways

void append_json(std::string& out, const CaseResult& result) { FieldWriter(out).value(result); }
void append_json(std::string& out, const RunInfo& info) { FieldWriter(out).value(info); }
void append_json(std::string& out, const RunEnd& end) { FieldWriter(out).value(end); }
void append_json(std::string& out, const SoakSample& sample) { FieldWriter(out).value(sample); }
void append_json(std::string& out, const SoakSummary& soak) { FieldWriter(out).value(soak); }
void append_json(std::string& out, const std::vector<SoakSample>& samples) {
  FieldWriter(out).value(samples);
}
void append_json(std::string& out, const std::map<std::string, ResponseFigures>& figures) {
  FieldWriter(out).value(figures);
}

void from_json(const nlohmann::json& json, CaseResult& result) {
  read_fields(json, result);
  if (result.id.empty()) refuse("the id is empty");  // JUnit of it would have a case without a name
}
void from_json(const nlohmann::json& json, RunInfo& info) { read_fields(json, info); }
void from_json(const nlohmann::json& json, RunEnd& end) { read_fields(json, end); }
void from_json(const nlohmann::json& json, SoakSample& sample) { read_fields(json, sample); }
void from_json(const nlohmann::json& json, SoakSummary& soak) { read_fields(json, soak); }

}  // namespace fieldproof::results
