// Double entry holds: no byte of a vector can change in one place without `lint` naming the vector.
#include <gtest/gtest.h>

#include <cctype>
#include <functional>
#include <optional>
#include <random>
#include <sstream>

#include "suites/tool/tool_files.hpp"

namespace fieldproof::tool_tests {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

constexpr unsigned seed = 20220;
constexpr std::size_t sample = 60;

/// Where a vector's bytes stand: a string of JSON, and the offsets in it that a byte hangs on.
struct Place {
  std::string* text;
  std::vector<std::size_t> at;
};

bool inside(const std::string& text, std::size_t at, char open, char close) {
  const std::size_t before = text.find_last_of(std::string{open, close}, at);
  return before != std::string::npos && text[before] == open;
}

/// Is this the '(' of a pdu(...)?
bool opens_body(const std::string& text, std::size_t at) {
  if (text[at] != '(') return false;
  const std::size_t word = text.rfind("pdu", at);
  return word != std::string::npos && text.find_first_of(" (", word) == at;
}

/// Characters in quotes, the digits of names and of bodies; what a row of `each` fills in is no
/// byte here.
std::vector<std::size_t> notation_offsets(const std::string& text) {
  std::vector<std::size_t> offsets;
  bool is_quoted = false;
  std::size_t name_until = 0;  // or the end of a body
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '\'') {
      is_quoted = !is_quoted;
    } else if (text.compare(i, 5, "name(") == 0 && !is_quoted) {
      name_until = text.find(')', i);
      i += 4;
    } else if (opens_body(text, i) && !is_quoted) {
      name_until = text.find_first_of("*:)", i);
    } else if (text.compare(i, 2, "${") == 0) {
      i = text.find('}', i);
    } else if ((is_quoted || i < name_until) && std::isalnum(static_cast<unsigned char>(text[i]))) {
      offsets.push_back(i);
    }
  }
  return offsets;
}

/// Hex digits; `??` is open.
std::vector<std::size_t> wire_offsets(const std::string& text) {
  std::vector<std::size_t> offsets;
  for (std::size_t i = 0; i < text.size(); ++i)
    if (std::isxdigit(static_cast<unsigned char>(text[i])) && !inside(text, i, '{', '}'))
      offsets.push_back(i);
  return offsets;
}

/// "05 30 31 ..": a whole frame.
bool is_wire(const std::string& text) {
  constexpr std::size_t shortest = 8;
  if (text.size() < 3 * shortest - 1) return false;
  for (std::size_t i = 0; i < text.size(); ++i)
    if (i % 3 == 2 ? text[i] != ' '
                   : text[i] != '?' && !std::isxdigit(static_cast<unsigned char>(text[i])))
      return false;
  return true;
}

using Offsets = std::vector<std::size_t> (*)(const std::string&);

/// A string, or the strings of named alternatives.
void add_places(ordered_json& value, Offsets offsets, std::vector<Place>& places) {
  if (value.is_object()) {
    for (auto& [name, alternative] : value.items())
      if (name != "reading") add_places(alternative, offsets, places);
  } else if (std::string& text = value.get_ref<std::string&>(); !offsets(text).empty()) {
    places.push_back({&text, offsets(text)});
  }
}

/// Another character of the same kind.
char changed(char c, std::mt19937& random) {
  const std::string digits = "0123456789", lower = "abcdef", upper = "ABCDEF";
  for (const std::string& kind : {digits, lower, upper}) {
    const std::size_t at = kind.find(c);
    if (at != std::string::npos) return kind[(at + 1 + random() % (kind.size() - 1)) % kind.size()];
  }
  return c == 'Z' || c == 'z' ? static_cast<char>(c - 1) : static_cast<char>(c + 1);
}

/// The ids of a vector: its own, or one a framing.
std::vector<std::string> ids_of(const ordered_json& vector) {
  const std::string id = vector.at("id");
  if (!vector.contains("framings")) return {id};
  std::vector<std::string> ids;
  for (const std::string framing : vector["framings"])
    ids.push_back(framing + id.substr(id.find('/')));
  return ids;
}

/// All vector files of a copy of the vectors, to change and write back.
class Vectors {
 public:
  Vectors() {
    fs::copy(FIELDPROOF_SOURCE_DIR "/vectors", folder_ / "vectors", fs::copy_options::recursive);
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(path())) {
      const std::string name = fs::relative(entry.path(), path()).string();
      if (entry.path().extension() != ".json" || name.ends_with("schema.json") ||
          name == "manuals.json" || name == "sections.json" || name == "faults.json" ||
          name.starts_with("statements/") || name.starts_with("errata/") ||
          name.starts_with("citations/"))
        continue;
      files_[name] = ordered_json::parse(read_text(entry.path()));
    }
  }
  std::string path() const { return folder_ / "vectors"; }
  void write() const {
    for (const auto& [name, document] : files_) folder_.write("vectors/" + name, document.dump(1));
  }

  std::vector<ordered_json*> must() {
    std::vector<ordered_json*> result;
    for (auto& [name, document] : files_) {
      if (name.starts_with("wires/")) continue;
      for (ordered_json& vector : document)
        if (vector.at("level") == "must" && vector.contains("steps")) result.push_back(&vector);
    }
    return result;
  }

  static std::vector<Place> notation(ordered_json& vector) {
    std::vector<Place> places;
    for (ordered_json& step : vector["steps"])
      for (const char* key : {"send", "expect"})
        if (step.contains(key)) add_places(step[key], notation_offsets, places);
    return places;
  }

  /// Literal bytes: in the steps, in the rows of `each`, and in the second entry under wires/.
  std::vector<Place> wire(ordered_json& vector) {
    std::vector<Place> places;
    for (ordered_json& step : vector["steps"])
      if (step.contains("wire")) add_places(step["wire"], wire_offsets, places);
    if (vector.contains("each")) add_rows(vector["each"], places);
    for (auto& [name, document] : files_)
      for (const std::string& id : ids_of(vector))
        if (name.starts_with("wires/")) add_second_entry(document, id, places);
    return places;
  }

 private:
  static void add_rows(ordered_json& each, std::vector<Place>& places) {
    for (auto& [dimension, rows] : each.items())
      for (ordered_json& row : rows)
        for (auto& [key, value] : row.items())
          if (is_wire(value.get_ref<const std::string&>())) add_places(value, wire_offsets, places);
  }
  static void add_second_entry(ordered_json& document, const std::string& id,
                               std::vector<Place>& places) {
    for (auto& [one, steps] : document.items()) {
      if (one != id && !one.starts_with(id + '/')) continue;
      for (auto& [index, wire] : steps.items()) add_places(wire, wire_offsets, places);
    }
  }

  TestFolder folder_;
  std::map<std::string, ordered_json> files_;
};

struct Change {
  std::vector<std::string> ids;
  std::string before, after;
};

using PlacesOf = std::function<std::vector<Place>(ordered_json&)>;

/// Changes one byte in each vector of a seeded sample, where `places_of` finds one; none of these
/// that are `taken`.
std::vector<Change> change_sample(Vectors& vectors, const PlacesOf& places_of,
                                  std::set<ordered_json*>& taken) {
  std::mt19937 random(seed);
  std::vector<ordered_json*> all = vectors.must();
  for (std::size_t i = all.size(); i > 1; --i)
    std::swap(all[i - 1], all[random() % i]);  // std::shuffle differs by library
  std::vector<Change> changes;
  for (ordered_json* vector : all) {
    if (changes.size() == sample) break;
    if (taken.contains(vector)) continue;
    const std::vector<Place> places = places_of(*vector);
    if (places.empty()) continue;
    const Place& place = places[random() % places.size()];
    char& c = (*place.text)[place.at[random() % place.at.size()]];
    const std::string before = *place.text;
    c = changed(c, random);
    changes.push_back({ids_of(*vector), before, *place.text});
    taken.insert(vector);
  }
  return changes;
}

/// Lines of `lint`; each names file, case and step.
std::set<std::string> lines_of(const Finished& lint) {
  EXPECT_EQ(lint.err, "");
  std::set<std::string> lines;
  std::istringstream in(lint.out);
  for (std::string line; std::getline(in, line);) lines.insert(line);
  return lines;
}

bool is_of(const std::string& id, const std::vector<std::string>& vectors) {
  return std::ranges::any_of(vectors, [&](const std::string& vector) {
    return id == vector || id.starts_with(vector + '/');
  });
}

/// "FILE: ID: ..." of one of these vectors.
bool names(const std::set<std::string>& lines, const std::vector<std::string>& vectors) {
  return std::ranges::any_of(lines, [&](const std::string& line) {
    const std::size_t at = line.find(": ");
    const std::size_t end = line.find(": ", at + 2);
    return end != std::string::npos && is_of(line.substr(at + 2, end - at - 2), vectors);
  });
}

/// In the notation of some vectors, in the literal bytes of others.
TEST(ByteChange, in_notation_or_literal_bytes_is_found) {
  Vectors vectors;
  std::set<ordered_json*> taken;
  std::vector<Change> changes = change_sample(vectors, Vectors::notation, taken);
  std::ranges::move(change_sample(
                        vectors, [&](ordered_json& vector) { return vectors.wire(vector); }, taken),
                    std::back_inserter(changes));
  ASSERT_EQ(changes.size(), 2 * sample) << "not enough vectors to change";
  const std::set<std::string> before = lines_of(lint_of_the_vectors());
  vectors.write();
  std::set<std::string> fresh;
  for (const std::string& line : lines_of(run_tool({"lint", "--vectors", vectors.path()})))
    if (!before.contains(line)) fresh.insert(line);
  for (const Change& one : changes)
    EXPECT_TRUE(names(fresh, one.ids))
        << one.ids.front() << " is not named; changed\n  " << one.before << "\nto\n  " << one.after;
}

/// The other half of the proof: the vectors as they are have no problem at all.
TEST(ByteChange, none_and_lint_is_green) {
  const Finished& finished = lint_of_the_vectors();
  EXPECT_EQ(finished.code, 0) << finished.out.substr(0, 2000) << finished.err;
}

/// Where the vector itself prints no literal bytes the run itself is the witness: an emulator
/// answers as the manual says, not as the vector does.
TEST(ByteChange, in_an_expected_frame_turns_the_run_red) {
  Vectors vectors;
  const auto expected_frames = [](ordered_json& vector) {
    std::vector<Place> places;
    for (ordered_json& step : vector["steps"])
      if (step.contains("expect") && step["expect"].is_string() && !step.contains("wire"))
        add_places(step["expect"], notation_offsets, places);
    return places;
  };
  std::set<ordered_json*> taken;
  const std::vector<Change> changes = change_sample(vectors, expected_frames, taken);
  ASSERT_EQ(changes.size(), sample);
  vectors.write();
  const TestFolder folder;
  std::string filter;
  for (const Change& one : changes)
    for (const std::string& id : one.ids) filter += id + ':' + id + "/*:";
  const Finished finished =
      run_tool({"run", "--vectors", vectors.path(), "--filter", filter, "--out", folder / "out"});
  ASSERT_TRUE(finished.code == 1 || finished.code == 3) << finished.out << finished.err;
  const Results results = read_results(folder / "out/results.ndjson");
  for (const Change& one : changes) {
    const bool red = std::ranges::any_of(results.cases, [&](const nlohmann::json& result) {
      return is_of(result.at("id"), one.ids) &&
             (result.at("verdict") == "FAIL" || result.at("verdict") == "ERROR");
    });
    EXPECT_TRUE(red) << one.ids.front() << " is not red; changed\n  " << one.before << "\nto\n  "
                     << one.after;
  }
}

}  // namespace
}  // namespace fieldproof::tool_tests
