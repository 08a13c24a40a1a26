// The files around a run of the tool, for its tests: small vectors to run, and the reports to look
// into.
#pragma once

#include <fmt/format.h>

#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <pugixml.hpp>
#include <set>
#include <string>
#include <vector>

#include "suites/tool/tool.hpp"

namespace fieldproof::tool_tests {

/// A request for one word of M100, and the answer of a device whose memory is zero.
inline constexpr const char* ask_word = "[ENQ st 'rSS' '01' name(%MW100) EOT BCC]";
inline constexpr const char* zero_word = "[ACK st 'rSS' '01' '02' '0000' ETX BCC]";
inline constexpr const char* wrong_word = "[ACK st 'rSS' '01' '02' '0001' ETX BCC]";

/// A vector of level must that asks and expects; tests replace what they are about.
inline nlohmann::ordered_json small_vector(const std::string& id,
                                           const nlohmann::ordered_json& expect = zero_word) {
  return {
      {"id", "xgt_cnet/" + id},
      {"rev", 1},
      {"title", "a vector of the tests of the tool"},
      {"statement", "m/1"},
      {"source", {{"manual", "m"}, {"section", "1"}, {"quote", "reads one word from the device"}}},
      {"level", "must"},
      {"basis", "printed rule"},
      {"steps", {{{"send", ask_word}}, {{"expect", expect}}}}};
}

/// `object` with another key.
inline nlohmann::ordered_json with(nlohmann::ordered_json object, const char* key,
                                   const nlohmann::ordered_json& value) {
  object[key] = value;
  return object;
}

/// Writes vectors/xgt_cnet/test.json; the folder for --vectors.
inline std::string write_vectors(const TestFolder& folder,
                                 const std::vector<nlohmann::ordered_json>& vectors) {
  folder.write("vectors/xgt_cnet/test.json", nlohmann::ordered_json(vectors).dump(1));
  return folder / "vectors";
}

/// `count` vectors that a healthy device passes.
inline std::vector<nlohmann::ordered_json> many_vectors(int count) {
  std::vector<nlohmann::ordered_json> vectors;
  for (int i = 0; i < count; ++i)
    vectors.push_back(small_vector("many/n" + std::to_string(1000 + i)));
  return vectors;
}

/// results.ndjson, read without the tool's own reader.
struct Results {
  nlohmann::json run, end, soak;  // null: no such line
  std::vector<nlohmann::json> samples;
  std::vector<nlohmann::json> cases;  // in the order of the run

  std::vector<std::string> ids() const {
    std::vector<std::string> result;
    for (const nlohmann::json& one : cases) result.push_back(one.at("id"));
    return result;
  }
  /// Of the first result of the case; null: there is none.
  nlohmann::json of(const std::string& id) const {
    for (const nlohmann::json& one : cases)
      if (one.at("id").get_ref<const std::string&>() == id) return one;
    return nullptr;
  }
  std::string verdict(const std::string& id) const {
    const nlohmann::json one = of(id);
    return one.is_null() ? "no result" : one.at("verdict").get<std::string>();
  }
  /// Test cases of JUnit that are no cases of the run: what else made it red.
  std::size_t gate_cases() const {
    if (end.is_null()) return 1;
    std::size_t count = 0;
    for (const nlohmann::json& reason : end.value("reasons", nlohmann::json::array()))
      count += reason.at("what") != "verdicts";
    return count;
  }
  std::vector<std::string> ids_of(const std::set<std::string>& verdicts) const {
    std::vector<std::string> result;
    for (const nlohmann::json& one : cases)
      if (verdicts.contains(one.at("verdict"))) result.push_back(one.at("id"));
    return result;
  }
  std::map<std::string, std::size_t> counts() const {
    std::map<std::string, std::size_t> result;
    for (const nlohmann::json& one : cases) ++result[one.at("verdict")];
    return result;
  }
};

/// That selects these cases alone.
inline std::string filter_of(const std::vector<std::string>& ids) {
  return fmt::format("{}", fmt::join(ids, ":"));
}

/// An incomplete last line is left out, as a killed run leaves one.
inline Results read_results(const std::string& path) {
  Results results;
  std::ifstream in(path);
  EXPECT_TRUE(in) << path << " is missing";
  for (std::string line; std::getline(in, line) && !in.eof();) {
    const nlohmann::json one = nlohmann::json::parse(line);
    if (one.contains("run"))
      results.run = one["run"];
    else if (one.contains("end"))
      results.end = one["end"];
    else if (one.contains("soak"))
      results.soak = one["soak"];
    else if (one.contains("sample"))
      results.samples.push_back(one["sample"]);
    else
      results.cases.push_back(one.at("case"));
  }
  return results;
}

/// junit.xml: its counts, and what each test case holds.
struct Junit {
  std::size_t tests = 0, failures = 0, errors = 0,
              skipped = 0;                      // as the attributes of the suites say
  std::map<std::string, pugi::xml_node> cases;  // "classname name"
  std::size_t children = 0;                     // test cases, also those of the same name
  pugi::xml_document document;

  std::size_t with(const char* element) const {
    return static_cast<std::size_t>(
        std::ranges::count_if(cases, [&](const auto& one) { return one.second.child(element); }));
  }
};

inline void read_junit(const std::string& path, Junit& junit) {
  const pugi::xml_parse_result parsed = junit.document.load_file(path.c_str());
  EXPECT_TRUE(parsed) << path << ": " << parsed.description();
  for (const pugi::xml_node suite : junit.document.child("testsuites").children("testsuite")) {
    junit.tests += suite.attribute("tests").as_uint();
    junit.failures += suite.attribute("failures").as_uint();
    junit.errors += suite.attribute("errors").as_uint();
    junit.skipped += suite.attribute("skipped").as_uint();
    for (const pugi::xml_node one : suite.children("testcase")) {
      ++junit.children;
      junit.cases[std::string(one.attribute("classname").value()) + ' ' +
                  one.attribute("name").value()] = one;
    }
  }
}

/// Jenkins' schema, by a validator that is not ours.
inline void expect_valid_junit(const std::string& path) {
  const Finished lint = run_program({"xmllint", "--noout", "--schema",
                                     FIELDPROOF_SOURCE_DIR "/reports/testdata/junit-10.xsd", path});
  EXPECT_EQ(lint.code, 0) << lint.err;
}

/// What a run must leave behind, however it ended: the three reports, and their counts agree.
inline void expect_reports(const std::string& out) {
  const Results results = read_results(out + "/results.ndjson");
  const nlohmann::json json =
      nlohmann::json::parse(read_text(out + "/results.json"), nullptr, false);
  ASSERT_FALSE(json.is_discarded()) << out << "/results.json is no JSON";
  EXPECT_EQ(json["counts"]["total"], results.cases.size());
  EXPECT_EQ(json["cases"].size(), results.cases.size());
  expect_valid_junit(out + "/junit.xml");
  Junit junit;
  read_junit(out + "/junit.xml", junit);
  const std::size_t expected = results.cases.size() + results.gate_cases();
  EXPECT_EQ(junit.tests, expected);
  EXPECT_EQ(junit.children, expected);
  const bool red = results.end.is_null() || results.end["exit_code"] != 0;
  EXPECT_EQ(red, junit.failures + junit.errors > 0) << "JUnit contradicts the exit code";
}

/// All vectors against the default endpoint: one run, however many tests of a program look at it.
struct DefaultRun {
  DefaultRun()
      : finished(run_tool({"run", "--out", out()})),
        results(read_results(out() + "/results.ndjson")) {}
  std::string out() const { return folder / "out"; }

  TestFolder folder;
  Finished finished;
  Results results;
};

inline const DefaultRun& default_run() {
  static const DefaultRun run;
  return run;
}

/// All vectors as they are, likewise.
inline const Finished& lint_of_the_vectors() {
  static const Finished finished = run_tool({"lint"});
  return finished;
}

}  // namespace fieldproof::tool_tests
