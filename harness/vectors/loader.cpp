#include "harness/vectors/loader.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <fstream>
#include <iterator>
#include <set>
#include <stdexcept>

#include "harness/vectors/fingerprint.hpp"
#include "harness/vectors/schema.hpp"
#include "src/base/duration.hpp"
#include "src/base/spelling.hpp"

namespace fieldproof::vectors {

namespace {

using json = nlohmann::ordered_json;  // the first of named alternatives is the preferred one
namespace fs = std::filesystem;

/// Broken vectors are thrown inside this file and become `problems`.
struct Broken : std::runtime_error {
  using std::runtime_error::runtime_error;
};

std::string read_file(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw Broken(fmt::format("cannot read {}; is it readable?", path.string()));
  return std::string(std::istreambuf_iterator<char>(in), {});
}

// ---- expansion of `each`
// -------------------------------------------------------------------------------------------

using Row = std::vector<std::pair<std::string, std::string>>;

std::string substitute(const std::string& text, const Row& row) {
  if (text.find("${") == std::string::npos) return text;
  std::string result;
  std::size_t from = 0;
  for (std::size_t at; (at = text.find("${", from)) != std::string::npos;) {
    const std::size_t end = text.find('}', at);
    if (end == std::string::npos) throw Broken(fmt::format("'${{' without '}}' in \"{}\"", text));
    const std::string key = text.substr(at + 2, end - at - 2);
    const auto found = std::ranges::find(row, key, &Row::value_type::first);
    if (found == row.end())
      throw Broken(fmt::format("no row of `each` gives '${{{}}}' in \"{}\"", key, text));
    result.append(text, from, at - from).append(found->second);
    from = end + 1;
  }
  return result.append(text, from);
}

json substitute(const json& value, const Row& row) {
  if (value.is_string()) return substitute(value.get_ref<const std::string&>(), row);
  if (value.is_array()) {
    json result = json::array();
    for (const json& element : value) result.push_back(substitute(element, row));
    return result;
  }
  if (!value.is_object()) return value;
  json result = json::object();
  for (const auto& [key, element] : value.items())
    result[substitute(key, row)] = substitute(element, row);
  return result;
}

struct Combination {
  std::string suffix;
  Row row;
};

/// The product of the rows of all dimensions, in the order of their names.
std::vector<Combination> combinations(const json& each) {
  std::vector<Combination> result{{}};
  for (const auto& [dimension, rows] : each.items()) {
    std::vector<Combination> next;
    for (const Combination& base : result)
      for (const json& row : rows) {
        Combination combination = base;
        combination.suffix += '/' + row.at("case").get<std::string>();
        for (const auto& [key, value] : row.items())
          if (key != "case") combination.row.emplace_back(key, value.get<std::string>());
        next.push_back(std::move(combination));
      }
    result = std::move(next);
  }
  return result;
}

// ---- one case
// ------------------------------------------------------------------------------------------------------

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
    const std::optional<std::string> digits = expand_hex(text);
    if (!digits) throw Broken(fmt::format("{}: '{}' are no hex digits", address, text));
    memory.emplace_back(address, *digits);
  }
  return memory;
}

Frame read_frame(const std::string& reading, const json& text, const json* wire, const Row& row) {
  Frame frame{reading, text_of(text, row), {}, {}};
  Result<notation::Notation> notation = notation::parse_notation(frame.text);
  if (!notation) throw Broken(fmt::format("\"{}\": {}", frame.text, notation.error().message));
  frame.notation = std::move(*notation);
  if (wire && wire->is_string()) frame.wire = text_of(*wire, row);
  if (wire && wire->is_object() && wire->contains(reading))
    frame.wire = text_of(wire->at(reading), row);
  return frame;
}

void read_expect(const json& value, const json* wire, const Row& row, Step& step) {
  step.kind = Step::Kind::expect;
  if (value.is_string()) {
    step.frames.push_back(read_frame("", value, wire, row));
    return;
  }
  step.reading = value.at("reading");
  for (const auto& [name, text] : value.items())
    if (name != "reading") step.frames.push_back(read_frame(name, text, wire, row));
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

void read_open(const json& value, const Row& row, Step& step) {
  step.kind = Step::Kind::open;
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
  if (value == "any") return std::nullopt;
  return value == "fin" ? LinkEvent::closed : LinkEvent::reset;
}

Step read_step(const json& value, const Row& row) {
  Step step;
  const json* wire = value.contains("wire") ? &value["wire"] : nullptr;
  int kinds = 0;
  const auto is = [&](const char* key) { return value.contains(key) && ++kinds; };
  if (is("send")) {
    step.kind = Step::Kind::send;
    step.frames.push_back(read_frame("", value["send"], wire, row));
  }
  if (is("expect")) read_expect(value["expect"], wire, row, step);
  if (is("silence")) step.kind = Step::Kind::silence;
  if (is("wait"))
    step.kind = Step::Kind::wait, step.duration = read_duration(text_of(value["wait"], row));
  if (is("set")) step.kind = Step::Kind::set, step.memory = read_memory(value["set"], row);
  if (is("check")) step.kind = Step::Kind::check, step.memory = read_memory(value["check"], row);
  if (is("do")) step.kind = Step::Kind::act, step.action = text_of(value["do"], row);
  if (is("open")) read_open(value["open"], row, step);
  if (is("close")) step.kind = Step::Kind::close, step.closing = read_closing(value["close"]);
  if (is("expect_close"))
    step.kind = Step::Kind::expect_close, step.ending = read_ending(value["expect_close"]);
  if (value.contains("partner")) {
    step.partner = read_partner(value["partner"], row);
    if (!value.contains("expect") && is("partner")) step.kind = Step::Kind::partner;
  }
  if (kinds != 1)
    throw Broken(
        fmt::format("a step is one of send, expect, partner, silence, wait, set, check, do, open, "
                    "close, expect_close; this one has {}",
                    kinds));
  if (value.contains("within")) step.within = read_duration(text_of(value["within"], row));
  if (value.contains("every")) step.every = read_duration(text_of(value["every"], row));
  if (value.contains("max_gap")) step.max_gap = read_duration(text_of(value["max_gap"], row));
  step.times = value.value("times", 1);
  if (value.contains("on")) step.on = text_of(value["on"], row);
  return step;
}

std::string protocol_of(const std::string& id) {
  std::string folder = id.substr(0, id.find('/'));
  std::ranges::replace(folder, '_', '-');
  return folder;
}

Source read_source(const json& value) {
  Source source{value.at("manual"), value.at("section"), value.at("quote"), {}};
  const json& statement = value.at("statement");
  if (statement.is_string())
    source.statements.push_back(statement);
  else
    source.statements = statement.get<std::vector<std::string>>();
  return source;
}

void read_given(const json& given, const Row& row, Case& result) {
  if (given.contains("config")) result.config = nlohmann::json(substitute(given["config"], row));
  if (!config_station(result.config, 1))
    throw Broken("given.config.station is not a number from 0 to 255");
  if (given.contains("memory")) result.memory = read_memory(given["memory"], row);
  result.fresh = given.value("fresh", false);
}

Case read_case(const json& vector, const Source& source, const Combination& combination,
               const std::string& file) {
  const Row& row = combination.row;
  Case result;
  result.vector_id = vector.at("id");
  result.id = result.vector_id + combination.suffix;
  result.rev = vector.at("rev");
  result.title = text_of(vector.at("title"), row);
  result.protocol = protocol_of(result.id);
  result.source = source;
  result.level = text_of(vector.at("level"), row);
  result.basis = text_of(vector.at("basis"), row);
  result.why = text_of(vector, "why", row);
  if (vector.contains("models"))
    for (const json& model : vector["models"]) result.models.push_back(text_of(model, row));
  result.transpose = vector.value("transpose", true);
  result.file = file;
  if (vector.contains("given")) read_given(vector["given"], row, result);
  if (vector.contains("facts")) result.facts = nlohmann::json(substitute(vector["facts"], row));
  if (!vector.contains("steps")) return result;
  const json& steps = vector["steps"];
  for (std::size_t i = 0; i < steps.size(); ++i) try {
      result.steps.push_back(read_step(steps[i], row));
    } catch (const Broken& broken) {
      throw Broken(fmt::format("steps[{}]: {}", i, broken.what()));
    }
  return result;
}

void read_vector(const json& vector, const std::string& file, VectorSet& set) {
  const std::string id = vector.at("id");
  const bool table = vector.value("kind", "case") == "table";
  const Source source = read_source(vector.at("source"));
  for (const Combination& combination :
       combinations(vector.contains("each") ? vector["each"] : json::object()))
    (table ? set.tables : set.cases).push_back(read_case(vector, source, combination, file));
  if (!vector.contains("errata")) return;
  for (const json& erratum : vector["errata"])
    set.errata.push_back({id, source.manual, source.section, erratum["printed"], erratum["correct"],
                          erratum["why"]});
}

/// "[12][steps][0]: ..." with the vector's id in place of its number.
std::string name_vector(const nlohmann::json& document, const std::string& problem) {
  std::size_t index = 0;
  if (std::sscanf(problem.c_str(), "[%zu]", &index) == 1 && document.is_array() &&
      index < document.size() && document[index].is_object() && document[index].contains("id") &&
      document[index]["id"].is_string())
    return document[index]["id"].get<std::string>() + problem.substr(problem.find(']') + 1);
  return problem;
}

std::vector<fs::path> json_files(const fs::path& folder) {
  if (fs::is_regular_file(folder)) return {folder};
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file() && entry.path().extension() == ".json")
      files.push_back(entry.path());
  std::ranges::sort(files);
  return files;
}

void load_statements(const std::string& text, VectorSet& set) {
  for (const json& value : json::parse(text)) {
    const std::string id = value.at("id");
    set.statements.push_back({id, id.substr(0, id.find('/')), value.at("section"),
                              value.at("quote"), value.value("reason", "")});
  }
}

void load_manuals(const std::string& text, VectorSet& set) {
  for (const json& value : json::parse(text))
    set.manuals.push_back(
        {value.at("id"), value.at("file"), value.at("title"), value.at("edition")});
}

void load_file(const fs::path& folder, const fs::path& path, VectorSet& set, std::uint64_t& hash) {
  const std::string name = fs::relative(path, folder).generic_string();
  if (name == "schema.json" || name.starts_with("wires/")) return;
  try {
    const std::string text = read_file(path);
    hash = extend_fingerprint(extend_fingerprint(hash, name), text);
    if (name == "manuals.json")
      load_manuals(text, set);
    else if (name.starts_with("statements/"))
      load_statements(text, set);
    else
      load_vector_text(text, name, set);
  } catch (const std::exception& error) {
    set.problems.push_back(fmt::format("{}: {}", name, error.what()));
  }
}

void report_duplicates(VectorSet& set) {
  std::set<std::string> ids;
  for (const std::vector<Case>* cases : {&set.cases, &set.tables})
    for (const Case& one : *cases)
      if (!ids.insert(one.id).second)
        set.problems.push_back(
            fmt::format("{}: the id {} is used twice; ids are chosen once", one.file, one.id));
}

bool glob(std::string_view text, std::string_view pattern) {
  if (pattern.empty()) return text.empty();
  if (pattern[0] == '*')
    return glob(text, pattern.substr(1)) || (!text.empty() && glob(text.substr(1), pattern));
  return !text.empty() && (pattern[0] == '?' || pattern[0] == text[0]) &&
         glob(text.substr(1), pattern.substr(1));
}

}  // namespace

namespace {

/// The literal bytes of one case: {"0": "05 30 ..", "1": {"as_sent": "06 ..", "upper": "06 .."}}.
void take_wires(const json& wires, Case& one) {
  for (const auto& [index, wire] : wires.items()) {
    const std::size_t at = index.find_first_not_of("0123456789") == std::string::npos
                               ? std::stoul(index)
                               : one.steps.size();
    if (at >= one.steps.size() || one.steps[at].frames.empty())
      throw Broken(fmt::format("steps[{}] sends and expects nothing", index));
    for (Frame& frame : one.steps[at].frames) {
      if (frame.wire) continue;
      if (wire.is_string())
        frame.wire = wire.get<std::string>();
      else if (wire.contains(frame.reading))
        frame.wire = wire.at(frame.reading).get<std::string>();
    }
  }
}

void load_wire_file(const fs::path& path, const std::string& name, VectorSet& set) {
  const json document = json::parse(read_file(path));
  for (const auto& [id, wires] : document.items()) try {
      const auto one = std::ranges::lower_bound(set.cases, id, {}, &Case::id);
      if (one == set.cases.end() || one->id != id) throw Broken("no such case");
      take_wires(wires, *one);
    } catch (const std::exception& error) {
      set.problems.push_back(fmt::format("{}: {}: {}", name, id, error.what()));
    }
}

}  // namespace

void load_wires(const fs::path& folder, VectorSet& set) {
  if (!fs::is_directory(folder / "wires")) return;
  for (const fs::path& path : json_files(folder / "wires")) {
    const std::string name = fs::relative(path, folder).generic_string();
    try {
      load_wire_file(path, name, set);
    } catch (const std::exception& error) {
      set.problems.push_back(fmt::format("{}: {}", name, error.what()));
    }
  }
}

void load_vector_text(std::string_view text, const std::string& file, VectorSet& set) {
  const json document = json::parse(text);
  const json vectors = document.is_object() ? json::array({document}) : document;
  if (const nlohmann::json plain(vectors); !set.schema.is_null()) {
    const std::vector<std::string> problems = schema_problems(set.schema, plain);
    for (const std::string& problem : problems)
      set.problems.push_back(fmt::format("{}: {}", file, name_vector(plain, problem)));
    if (!problems.empty()) return;
  }
  for (const json& vector : vectors) try {
      read_vector(vector, file, set);
    } catch (const std::exception& error) {
      const bool named = vector.is_object() && vector.contains("id") && vector["id"].is_string();
      set.problems.push_back(fmt::format(
          "{}: {}: {}", file, named ? vector["id"].get<std::string>() : "a vector", error.what()));
    }
}

VectorSet load_vectors(const fs::path& folder, const fs::path& schema_file) {
  VectorSet set;
  if (!fs::exists(folder)) {
    set.problems.push_back(
        fmt::format("cannot find the vectors in {}; name their folder, or one file, with --vectors",
                    folder.string()));
    return set;
  }
  try {
    const fs::path own = folder / "schema.json";
    set.schema = nlohmann::json::parse(
        read_file(fs::exists(own) || schema_file.empty() ? own : schema_file));
  } catch (const std::exception& error) {
    set.problems.push_back(fmt::format("schema.json: {}", error.what()));
    return set;
  }
  std::uint64_t hash = empty_fingerprint;
  const fs::path base = fs::is_directory(folder) ? folder : folder.parent_path();
  for (const fs::path& path : json_files(folder)) load_file(base, path, set, hash);
  report_duplicates(set);
  std::ranges::sort(set.cases, {}, &Case::id);
  set.hash = fmt::format("{:016x}", hash);
  return set;
}

bool matches_filter(std::string_view id, std::string_view filter) {
  bool selected = filter.empty() || filter.starts_with('-');
  while (!filter.empty()) {
    const std::string_view part = filter.substr(0, filter.find(':'));
    filter.remove_prefix(std::min(part.size() + 1, filter.size()));
    if (part.starts_with('-') ? glob(id, part.substr(1)) : glob(id, part))
      selected = !part.starts_with('-');
  }
  return selected;
}

}  // namespace fieldproof::vectors
