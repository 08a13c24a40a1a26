#include "harness/vectors/case_reader.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <map>

#include "harness/vectors/json/broken.hpp"
#include "harness/vectors/json/framings.hpp"
#include "harness/vectors/transactions.hpp"
#include "src/base/duration.hpp"
#include "src/base/spelling.hpp"

namespace fieldproof::vectors {

namespace {

using json = nlohmann::ordered_json;  // the first of named alternatives is the preferred one

Duration read_duration(const std::string& text) {
  const Result<Duration> duration = parse_duration(text);
  if (!duration) throw Broken(duration.error().message);
  return *duration;
}

// One vector makes up to a thousand cases: texts are substituted where they are read, without a
// JSON tree for each case.

/// The text at `value`, substituted.
std::string text_of(const json& value, const Row& row) {
  return substitute(value.get_ref<const std::string&>(), row);
}
std::string text_of(const json& value, const char* key, const Row& row) {
  return value.contains(key) ? text_of(value[key], row) : "";
}

std::vector<std::pair<std::string, std::string>> read_memory(const json& value, const Row& row) {
  std::vector<std::pair<std::string, std::string>> memory;
  for (const auto& [key, hex] : value.items()) {
    const std::string address = substitute(key, row), text = text_of(hex, row);
    if (const std::optional<Number> number = read_number(text)) {
      if (number->is_range())
        throw Broken(fmt::format("{}: '{}' is a range; only a check may have one", address, text));
      memory.emplace_back(address, number->digits());
      continue;
    }
    const std::optional<std::string> digits = expand_hex(text);
    if (!digits)
      throw Broken(
          fmt::format("{}: '{}' are no hex digits, nor a number as dec(1500), dec32(-400), "
                      "float(0.5)",
                      address, text));
    memory.emplace_back(address, *digits);
  }
  return memory;
}

/// Values at addresses: numbers may lie between two.
void read_values(const json& value, const Row& row, Step& step) {
  for (const auto& [key, text] : value.items()) {
    if (!text.is_string())
      throw Broken(fmt::format("'{}': named alternatives need a \"reading\"", key));
    const std::optional<Number> number = read_number(text_of(text, row));
    step.numbers.push_back(number);
    if (number)
      step.memory.emplace_back(substitute(key, row), number->digits());
    else
      step.memory.push_back(read_memory(json{{key, text}}, row).front());
  }
}

/// All look at the same memory, so that one look at it tells which is true.
void require_same_places(const Step& first, const Step& other, const std::string& name) {
  const auto same = [](const auto& one, const auto& two) {
    return one.first == two.first && one.second.size() == two.second.size();
  };
  if (!std::ranges::equal(first.memory, other.memory, same))
    throw Broken(
        fmt::format("alternative '{}' has other addresses than the first, or values of "
                    "another length; all have the same, in the same order",
                    name));
}

/// What must be there, or named alternatives of it.
void read_checked(const json& value, const Row& row, Step& step) {
  if (!value.contains("reading")) return read_values(value, row, step);
  step.reading = text_of(value["reading"], row);
  for (const auto& [name, values] : value.items()) {
    if (name == "reading") continue;
    if (!values.is_object())
      throw Broken(fmt::format("alternative '{}' is no object of addresses and values", name));
    Step one;
    read_values(values, row, one);
    if (step.alternatives.empty()) {
      step.memory = one.memory;
      step.numbers = one.numbers;
    }
    require_same_places(step, one, name);
    CheckedValues& found = step.alternatives.emplace_back(CheckedValues{name, {}, one.numbers});
    for (const auto& [address, digits] : one.memory) found.digits.push_back(digits);
  }
  if (step.alternatives.size() < 2)
    throw Broken(fmt::format("reading '{}' has one alternative; name two or more", step.reading));
}

PartnerSpec read_partner(const json& value, const Row& row) {
  PartnerSpec partner;
  for (const auto& [key, entry] : value.items()) {
    if (key == "model")
      partner.model = text_of(entry, row);
    else if (key == "memory")
      partner.memory = read_memory(entry, row);
    else if (key == "fault")
      partner.fault = text_of(entry, row);
    else
      partner.config[key] = nlohmann::json(substitute(entry, row));
  }
  if (!config_station(partner.config, 1))
    throw Broken("partner.station is not a number from 0 to 255");
  if (!partner.fault.empty() && partner.fault != "none" &&
      std::ranges::find(partner_faults, partner.fault) == partner_faults.end())
    throw Broken(fmt::format("unknown fault '{}'{}; the faults of a partner are {}", partner.fault,
                             suggestion(partner.fault, partner_faults),
                             fmt::join(partner_faults, ", ")));
  if (partner.fault == "none") partner.fault.clear();
  return partner;
}

/// One id, or several.
std::vector<std::string> read_ids(const json& value, const Row& row) {
  if (value.is_string()) return {text_of(value, row)};
  std::vector<std::string> ids;
  for (const json& id : value) ids.push_back(text_of(id, row));
  return ids;
}

Source read_source(const json& vector, const Row& row) {
  Source source;
  if (vector.contains("statement")) source.statements = read_ids(vector["statement"], row);
  if (vector.contains("source")) {
    const json& own = vector["source"];
    source.manual = own.at("manual");
    source.section = own.at("section");
    source.quote = own.at("quote");
    // As files of earlier editions have it.
    if (source.statements.empty() && own.contains("statement"))
      source.statements = read_ids(own["statement"], row);
  } else if (source.statements.empty()) {
    throw Broken(
        "rests on nothing: name a \"statement\" of a manual, or give the \"source\" of your own "
        "document (manual, section, quote)");
  }
  return source;
}

void read_given(const json& given, const Row& row, Case& result) {
  if (given.contains("config")) result.config = nlohmann::json(substitute(given["config"], row));
  if (!config_station(result.config, 1))
    throw Broken("given.config.station is not a number from 0 to 255");
  if (given.contains("memory")) result.memory = read_memory(given["memory"], row);
  result.fresh = given.value("fresh", false);
}

void read_open(const json& value, const Row& row, Step& step) {
  if (value.is_string()) {
    step.on = text_of(value, row);
    return;
  }
  step.on = text_of(value, "name", row);
  step.link.protocol = text_of(value, "protocol", row);
  if (value.value("transport", "tcp") == "udp") step.link.transport = Transport::udp;
  step.link.port = value.value("port", std::uint16_t{0});
}

Closing read_closing(const json& value) {
  return value == "fin" ? Closing::fin : value == "rst" ? Closing::rst : Closing::vanish;
}

std::optional<LinkEvent> read_ending(const json& value) {
  if (value == "any" || value == "may") return std::nullopt;
  return value == "fin" ? LinkEvent::closed : LinkEvent::reset;
}

constexpr std::array<std::pair<std::string_view, Step::Kind>, 12> kinds{
    {{"send", Step::Kind::send},
     {"expect", Step::Kind::expect},
     {"partner", Step::Kind::partner},
     {"silence", Step::Kind::silence},
     {"wait", Step::Kind::wait},
     {"set", Step::Kind::set},
     {"check", Step::Kind::check},
     {"do", Step::Kind::act},
     {"open", Step::Kind::open},
     {"close", Step::Kind::close},
     {"expect_close", Step::Kind::expect_close},
     {"expect_open", Step::Kind::expect_open}}};

/// What kind of step it is. A partner may stand in an expect.
Step::Kind kind_of(const json& value) {
  std::vector<std::pair<std::string_view, Step::Kind>> found;
  for (const auto& kind : kinds)
    if (value.contains(kind.first) &&
        !(kind.second == Step::Kind::partner && value.contains("expect")))
      found.push_back(kind);
  if (found.size() == 1) return found.front().second;
  std::vector<std::string_view> names;
  for (const auto& [name, kind] : kinds) names.push_back(name);
  throw Broken(
      fmt::format("a step is one of {}; this one has {}", fmt::join(names, ", "), found.size()));
}

/// An option that would be passed over is a slip.
void check_options(const json& value, Step::Kind kind) {
  const bool expects = kind == Step::Kind::expect || kind == Step::Kind::partner;
  const bool limited = expects || kind == Step::Kind::silence || kind == Step::Kind::expect_close ||
                       kind == Step::Kind::expect_open;
  for (const char* const option : {"every", "times", "max_gap"})
    if (value.contains(option) && !expects)
      throw Broken(fmt::format("\"{}\" is an option of expect alone", option));
  if (value.contains("within") && !limited)
    throw Broken(
        "\"within\" is an option of expect, silence, expect_close and expect_open alone; a check "
        "looks once, behind a wait");
}

/// The steps of one case, in order.
class StepReader {
 public:
  StepReader(const Row& row, const notation::Dressing* dressing, bool client)
      : row_(row),
        dressing_(dressing),
        client_(client),
        transactions_(client, dressing && dressing->low_byte_first) {}

  Step read(const json& value) {
    Step step;
    step.kind = kind_of(value);
    check_options(value, step.kind);
    if (value.contains("on")) step.on = text_of(value["on"], row_);
    if (step.kind == Step::Kind::open) read_open(value["open"], row_, step);
    if (step.kind == Step::Kind::close) step.closing = read_closing(value["close"]);
    read_content(value, step);
    if (value.contains("partner")) step.partner = read_partner(value["partner"], row_);
    if (value.contains("within")) step.within = duration(value["within"]);
    if (value.contains("every")) step.every = duration(value["every"]);
    if (value.contains("max_gap")) step.max_gap = duration(value["max_gap"]);
    step.times = value.value("times", 1);
    if (value.contains("clause")) step.source.statements = read_ids(value["clause"], row_);
    return step;
  }

 private:
  Duration duration(const json& value) const { return read_duration(text_of(value, row_)); }

  void read_content(const json& value, Step& step) {
    switch (step.kind) {
      case Step::Kind::send: return read_frames(value["send"], value, step);
      case Step::Kind::expect: return read_frames(value["expect"], value, step);
      case Step::Kind::silence: return read_silence(step);
      case Step::Kind::wait: step.duration = duration(value["wait"]); return;
      case Step::Kind::set: step.memory = read_memory(value["set"], row_); return;
      case Step::Kind::check: read_checked(value["check"], row_, step); return;
      case Step::Kind::act: step.action = text_of(value["do"], row_); return;
      case Step::Kind::expect_close:
        step.ending = read_ending(value["expect_close"]);
        step.may_stay = value["expect_close"] == "may";
        return;
      case Step::Kind::expect_open: return read_open(value["expect_open"], row_, step);
      case Step::Kind::open:
      case Step::Kind::close:
      case Step::Kind::partner: return;
    }
  }

  void read_silence(const Step& step) {
    transactions_.begin(step.kind, step.on);
    transactions_.end();
  }

  /// One frame, or named alternatives.
  void read_frames(const json& value, const json& step_value, Step& step) {
    const json* wire = step_value.contains("wire") ? &step_value["wire"] : nullptr;
    const bool sends = step.kind == Step::Kind::send;
    transactions_.begin(step.kind, step.on);
    if (value.is_string()) {
      step.frames.push_back(frame("", value, wire, sends));
    } else {
      step.reading = value.at("reading");
      for (const auto& [name, text] : value.items()) {
        if (name == "reading") continue;
        transactions_.again();
        step.frames.push_back(frame(name, text, wire, sends));
      }
    }
    transactions_.end();
  }

  Frame frame(const std::string& reading, const json& text, const json* wire, bool sends) {
    std::string written = text_of(text, row_);
    Frame frame{reading, dressed(written, sends), {}, {}};
    if (frame.text != written) frame.body = std::move(written);
    Result<notation::Notation> notation = notation::parse_notation(frame.text);
    if (!notation) throw Broken(fmt::format("\"{}\": {}", frame.text, notation.error().message));
    frame.notation = std::move(*notation);
    remember_captures(frame.notation);
    if (wire && wire->is_string()) frame.wire = text_of(*wire, row_);
    if (wire && wire->is_object() && wire->contains(reading))
      frame.wire = text_of(wire->at(reading), row_);
    return frame;
  }

  /// {id} is as long as {id:n} of an earlier frame made it.
  void remember_captures(notation::Notation& frame) {
    using Kind = notation::Item::Kind;
    for (notation::Item& item : frame) {
      if (item.kind == Kind::capture) captured_[item.text] = item.number;
      if (item.kind != Kind::reuse) continue;
      if (const auto found = captured_.find(item.text); found != captured_.end())
        item.number = found->second;
    }
  }

  std::string dressed(std::string text, bool sends) {
    if (text.find("pdu") == text.npos || !notation::has_pdu(text)) return text;
    if (!dressing_)
      throw Broken(
          fmt::format("\"{}\": this protocol frames no pdu(...); write the whole frame, "
                      "or name the `framings` of the vector",
                      text));
    Result<std::string> result = notation::dress(text, dressing_->of(!client_, sends),
                                                 [this] { return transactions_.next(); });
    if (!result) throw Broken(fmt::format("\"{}\": {}", text, result.error().message));
    return std::move(*result);
  }

  const Row& row_;
  const notation::Dressing* dressing_;
  bool client_;  // the device asks
  Transactions transactions_;
  std::map<std::string, int> captured_;  // sizes, by name
};

}  // namespace

namespace {

bool is_on_a_wire(Step::Kind kind) {
  constexpr std::array off{Step::Kind::wait, Step::Kind::set, Step::Kind::check, Step::Kind::act};
  return std::ranges::find(off, kind) == off.end();
}

}  // namespace

CaseReader::CaseReader(const json& vector, std::string file, const notation::Dressing* dressing)
    : vector_(vector), file_(std::move(file)), dressing_(dressing) {}

Case CaseReader::read(const Combination& combination) const {
  const Row& row = combination.row;
  Case result;
  result.vector_id = vector_.at("id");
  result.id = result.vector_id + combination.suffix;
  result.rev = vector_.value("rev", 1);
  result.title = text_of(vector_.at("title"), row);
  result.protocol = protocol_of(result.id);
  result.source = read_source(vector_, row);
  result.level = text_of(vector_.at("level"), row);
  result.basis = text_of(vector_.at("basis"), row);
  result.why = text_of(vector_, "why", row);
  if (const std::string kind = vector_.value("kind", "case"); kind != "case" && kind != "table")
    result.on_model = kind;
  if (vector_.contains("decision"))
    for (const json& id : vector_["decision"]) result.decisions.push_back({id, {}});
  if (vector_.contains("models"))
    for (const json& model : vector_["models"]) result.models.push_back(text_of(model, row));
  result.transpose = vector_.value("transpose", true);
  result.line_alone = vector_.value("line_alone", false);
  result.file = file_;
  if (vector_.contains("given")) read_given(vector_["given"], row, result);
  if (vector_.contains("facts")) result.facts = nlohmann::json(substitute(vector_["facts"], row));
  if (!vector_.contains("steps")) return result;
  const json& steps = vector_["steps"];
  StepReader reader(row, dressing_, is_client_case(result));
  for (std::size_t i = 0; i < steps.size(); ++i) try {
      result.steps.push_back(reader.read(steps[i]));
      if (!result.on_model.empty() && is_on_a_wire(result.steps.back().kind))
        throw Broken(
            fmt::format("kind '{}' is of a model: it has no step on a wire; leave the "
                        "kind out",
                        result.on_model));
    } catch (const Broken& broken) {
      throw Broken(fmt::format("steps[{}]: {}", i, broken.what()));
    }
  return result;
}

Step::Kind step_kind(std::string_view key) {
  for (const auto& [name, kind] : kinds)
    if (name == key) return kind;
  throw Broken(fmt::format("there is no step '{}'", key));
}

}  // namespace fieldproof::vectors
