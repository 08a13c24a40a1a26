// `compare`, `run --baseline` and `judge` of the built tool, on runs of the emulator and of devices
// with known faults.
#include <gmock/gmock.h>

#include <sstream>

#include "reports/results/test_json_schema.hpp"
#include "suites/tool/tool_files.hpp"

namespace fieldproof::tool_tests {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

const std::string stored = FIELDPROOF_SOURCE_DIR "/reports/testdata/results-1";

std::string broken(const std::string& fault) {
  return "exec:" BROKEN_SERVER " " + fault + " {tty}";
}

/// "change: id" for each test case of a comparison that is not plain.
std::vector<std::string> differences(const std::string& path) {
  std::vector<std::string> found;
  Junit junit;
  read_junit(path, junit);
  for (const auto& [name, node] : junit.cases)
    for (const char* element : {"failure", "skipped"})
      if (const pugi::xml_node outcome = node.child(element))
        found.push_back(name + ": " + outcome.attribute("message").value());
  return found;
}

class CompareCommand : public testing::Test {
 protected:
  /// Runs cases against an endpoint; the results file.
  std::string run_on(const std::string& name, const std::string& endpoint,
                     const std::string& filter, std::vector<std::string> more = {}) {
    std::vector<std::string> arguments{"run",      "--endpoint", endpoint, "--profile",   "xbc-h",
                                       "--filter", filter,       "--out",  folder_ / name};
    arguments.insert(arguments.end(), more.begin(), more.end());
    last_run_ = run_tool(arguments);
    return folder_ / (name + "/results.ndjson");
  }
  Finished compare(std::vector<std::string> files) {
    files.insert(files.begin(), "compare");
    for (const char* option : {"--html", "--junit"}) {
      files.push_back(option);
      files.push_back(folder_ / (std::string("compare") +
                                 (std::string(option) == "--html" ? ".html" : ".xml")));
    }
    return run_tool(files);
  }
  TestFolder folder_;
  Finished last_run_;
};

/// What these faults spoil among four cases, and nothing else.
TEST_F(CompareCommand, NamesExactlyWhatThreeBrokenDevicesDoWrong) {
  const std::string narrow = "xgt_cnet/rss/refused/*:xgt_cnet/rss/two_words_refused/*";
  const std::string good = run_on("good", "emulator:xbc-h", narrow);
  ASSERT_EQ(last_run_.code, 0) << last_run_.out;
  const std::string code =
      run_on("code", broken("0011_for_1132"), narrow, {"--allow-write", "all"});
  const std::string sum = run_on("sum", broken("bcc_off_by_one"), narrow, {"--allow-write", "all"});
  const std::string upper =
      run_on("upper", broken("bcc_on_upper_case"), narrow, {"--allow-write", "all"});
  const std::string none = run_on("none", broken("none"), narrow, {"--allow-write", "all"});
  const std::string lower_1 = "compare_A_B.xgt_cnet.rss refused/lower",
                    upper_1 = "compare_A_B.xgt_cnet.rss refused/upper";
  const std::string lower_2 = "compare_A_B.xgt_cnet.rss two_words_refused/lower",
                    upper_2 = "compare_A_B.xgt_cnet.rss two_words_refused/upper";
  const std::string newly_failing = ": newly failing: PASS -> FAIL";

  const Finished against_code = compare({good, code});
  EXPECT_EQ(against_code.code, 1) << against_code.err;
  EXPECT_THAT(differences(folder_ / "compare.xml"),
              ElementsAre(lower_1 + newly_failing, upper_1 + newly_failing, lower_2 + newly_failing,
                          upper_2 + newly_failing));
  EXPECT_THAT(against_code.out, AllOf(HasSubstr("A to B: 4 newly failing; 0 of 4 cases unchanged"),
                                      HasSubstr("exit 1: something got worse"),
                                      HasSubstr("error code: expected 1132 device memory: no such "
                                                "area, or not writable, got 0011 data error")));
  expect_valid_junit(folder_ / "compare.xml");

  EXPECT_EQ(compare({good, sum}).code, 1);
  EXPECT_THAT(differences(folder_ / "compare.xml"),
              ElementsAre(lower_1 + newly_failing, lower_2 + newly_failing));
  EXPECT_EQ(compare({good, upper}).code, 1);
  EXPECT_THAT(differences(folder_ / "compare.xml"),
              ElementsAre(upper_1 + newly_failing, upper_2 + newly_failing));
  const Finished against_none = compare({good, none});
  EXPECT_EQ(against_none.code, 0) << against_none.out;
  EXPECT_THAT(differences(folder_ / "compare.xml"), IsEmpty());

  const Finished between = compare({code, sum});
  EXPECT_EQ(between.code, 0) << "nothing got worse: " << between.out;
  EXPECT_THAT(between.out,
              AllOf(HasSubstr("newly passing: red before, and holds now (2)\n  "
                              "xgt_cnet/rss/refused/upper  FAIL -> PASS\n"
                              "  xgt_cnet/rss/two_words_refused/upper  FAIL -> PASS\n"),
                    HasSubstr("still failing, for another reason: red in both runs, but the "
                              "failure is another (2)\n"
                              "  xgt_cnet/rss/refused/lower  FAIL -> FAIL\n"
                              "      was: error code: expected 1132 device memory: no such area, "
                              "or not writable, got 0011 data error\n"
                              "      now: BCC: ")));

  const Finished all = compare({good, code, sum, upper, none});
  EXPECT_EQ(all.code, 1);
  EXPECT_THAT(all.out,
              HasSubstr("cases that differ (4)\n"
                        "  case                                  A     B     C     D     E\n"
                        "  xgt_cnet/rss/refused/lower            PASS  FAIL  FAIL  PASS  PASS\n"
                        "  xgt_cnet/rss/refused/upper            PASS  FAIL  PASS  FAIL  PASS\n"
                        "  xgt_cnet/rss/two_words_refused/lower  PASS  FAIL  FAIL  PASS  PASS\n"
                        "  xgt_cnet/rss/two_words_refused/upper  PASS  FAIL  PASS  FAIL  PASS\n"));
  expect_valid_junit(folder_ / "compare.xml");
  pugi::xml_document html;
  EXPECT_TRUE(html.load_file((folder_ / "compare.html").c_str())) << "well-formed";
  EXPECT_EQ(html.select_nodes("//span[@class='verdict v-fail']").size(), 2 * (4u + 2 + 2))
      << "in the lists, and in the matrix";
}

/// A slower device: the emulator with a delay, eight repetitions each. Simulated time is exact, so
/// every reply shifts.
TEST_F(CompareCommand, ASlowerDeviceIsWorse) {
  ordered_json fast = small_vector("t/read"), slow = small_vector("t/read");
  fast["given"]["config"] = {{"rs485", true}, {"delay_ms", 0}};
  slow["given"]["config"] = {{"rs485", true}, {"delay_ms", 10}};
  const auto run_with = [&](const char* name, const ordered_json& vector) {
    const TestFolder vectors;
    return run_on(name, "emulator:xbc-h", "*",
                  {"--repeat", "8", "--vectors", write_vectors(vectors, {vector})});
  };
  const std::string before = run_with("before", fast), after = run_with("after", slow);
  const Finished slower = compare({before, after});
  EXPECT_EQ(slower.code, 1) << slower.out;
  EXPECT_THAT(slower.out,
              AllOf(HasSubstr("slower  xgt_cnet/t/read\n      0.000 to 10.000 ms (+10.000 ms), p "
                              "0.00016, corrected 0.00016, 8 and 8 replies"),
                    HasSubstr("A to B: 1 slower")));
  const Finished faster = compare({after, before});
  EXPECT_EQ(faster.code, 0) << faster.out;
  EXPECT_THAT(faster.out, HasSubstr("faster  xgt_cnet/t/read"));
}

TEST_F(CompareCommand, ReadsEveryKindOfItsOwnFilesAndOldOnes) {
  for (const char* kind : {".ndjson", ".json", ".xml"}) {
    const Finished same = run_tool({"compare", stored + ".ndjson", stored + kind});
    EXPECT_EQ(same.code, 0) << same.out << same.err;
    EXPECT_THAT(same.out, HasSubstr("nothing got worse; 6 of 6 cases unchanged"));
  }
}

TEST_F(CompareCommand, UnreadableFilesAreNamedAndExitWith2) {
  const std::string cut = folder_.write("cut.json", read_text(stored + ".json").substr(0, 700));
  const Finished finished = run_tool({"compare", stored + ".json", cut});
  EXPECT_EQ(finished.code, 2);
  EXPECT_THAT(finished.err, AllOf(HasSubstr(cut), HasSubstr("line ")));
  EXPECT_EQ(run_tool({"compare", stored + ".json"}).code, 2) << "one file";
  EXPECT_EQ(run_tool({"compare", stored + ".json", folder_ / "none"}).code, 2);
  EXPECT_EQ(run_tool({"run", "--baseline", cut, "--out", folder_ / "out"}).code, 2);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out")) << "before anything is run";
}

// ---- run --baseline

TEST_F(CompareCommand, ARunWorseThanItsBaselineFails) {
  const TestFolder vectors;
  const auto run_against = [&](const ordered_json& expect, const std::string& baseline) {
    std::vector<std::string> more{
        "--vectors",
        write_vectors(vectors, {small_vector("b/one"), small_vector("b/two", expect)})};
    if (!baseline.empty()) more.insert(more.end(), {"--baseline", baseline});
    return run_on(baseline.empty() ? "base" : "now", "emulator:xbc-h", "*", more);
  };
  const std::string good = run_against(zero_word, "");
  run_against(zero_word, good);
  EXPECT_EQ(last_run_.code, 0) << last_run_.out;
  EXPECT_THAT(last_run_.out, HasSubstr("nothing got worse; 2 of 2 cases unchanged"));

  // NON-STRICT passes this gate, but is less than it was.
  const std::string now =
      run_against({{"reading", "word"}, {"one", wrong_word}, {"zero", zero_word}}, good);
  EXPECT_EQ(last_run_.code, 1) << last_run_.out;
  EXPECT_THAT(last_run_.out,
              AllOf(HasSubstr("weaker"), HasSubstr("A to B: 1 weaker"), HasSubstr("exit 1: ")));
  EXPECT_EQ(read_results(now).end.at("exit_code"), 1);
  EXPECT_THAT(differences(folder_ / "now/compare.xml"),
              ElementsAre("compare_A_B.xgt_cnet.b two: weaker: PASS -> NON-STRICT"));

  // A failure that the baseline has, too, is no better for it: the worse of the two exit codes
  // counts.
  const std::string bad = run_against(wrong_word, "");
  run_against(wrong_word, bad);
  EXPECT_EQ(last_run_.code, 1);
  EXPECT_THAT(last_run_.out, HasSubstr("nothing got worse"));
}

TEST_F(CompareCommand, CasesThatWereNotSelectedAreNotMissing) {
  const std::string all = run_on("all", "emulator:xbc-h", "xgt_cnet/rss/refused/*");
  run_on("part", "emulator:xbc-h", "xgt_cnet/rss/refused/lower", {"--baseline", all});
  EXPECT_EQ(last_run_.code, 0) << last_run_.out;
  EXPECT_THAT(last_run_.out, AllOf(HasSubstr("1 of 1 cases unchanged"), Not(HasSubstr("removed"))));
}

// ---- judge

/// Verdicts by case of the results in a folder.
std::map<std::string, std::string> verdicts(const std::string& folder) {
  std::map<std::string, std::string> found;
  for (const json& one : read_results(folder + "/results.ndjson").cases)
    found[one.at("id")] = one.at("verdict");
  return found;
}

/// "  2882  PASS  as the manual says" of each verdict that occurs.
std::string counts_in(const std::string& out) {
  std::istringstream in(out.substr(std::min(out.find(" cases in "), out.size())));
  std::string text;
  std::getline(in, text);
  text.clear();
  for (std::string line; std::getline(in, line) && !line.empty();) text += line + '\n';
  return text;
}

TEST_F(CompareCommand, JudgesEveryCaseOfTheEmulatorAsTheRunDid) {
  const Finished run = run_tool({"run", "--filter", "xgt_cnet/*", "--out", folder_ / "all"});
  ASSERT_EQ(run.code, 0);
  const Finished judged =
      run_tool({"judge", folder_ / "all/results.ndjson", "--out", folder_ / "judged"});
  EXPECT_EQ(judged.code, 0) << judged.out << judged.err;
  EXPECT_THAT(judged.out,
              AllOf(HasSubstr("verdicts that changed (0)"), Not(HasSubstr("not judged again"))));
  EXPECT_THAT(counts_in(run.out), HasSubstr("PASS"));
  EXPECT_EQ(counts_in(judged.out), counts_in(run.out));
}

TEST_F(CompareCommand, JudgesTheJsonReportToo) {
  run_on("small", "emulator:xbc-h", "xgt_cnet/rss/refused/*");
  const Finished judged =
      run_tool({"judge", folder_ / "small/results.json", "--out", folder_ / "judged"});
  EXPECT_EQ(judged.code, 0) << judged.out << judged.err;
  EXPECT_EQ(verdicts(folder_ / "judged"), verdicts(folder_ / "small"));
  expect_reports(folder_ / "judged");
}

TEST_F(CompareCommand, JudgesADeviceInRealTimeAsTheRunDid) {
  const std::string filter = "xgt_cnet/rss/refused/*:xgt_cnet/wss/*word*";
  const std::string recorded =
      run_on("real", broken("0011_for_1132"), filter, {"--allow-write", "all"});
  EXPECT_EQ(last_run_.code, 1) << last_run_.out << last_run_.err;
  const Finished judged = run_tool({"judge", recorded, "--out", folder_ / "judged"});
  EXPECT_EQ(judged.code, 1) << judged.out << judged.err;
  EXPECT_THAT(judged.out, HasSubstr("verdicts that changed (0)"));
  EXPECT_EQ(verdicts(folder_ / "judged"), verdicts(folder_ / "real"));
  const json failure =
      read_results(folder_ / "judged/results.ndjson").of("xgt_cnet/rss/refused/lower");
  const json live = read_results(recorded).of("xgt_cnet/rss/refused/lower");
  for (const char* key :
       {"message", "expected", "received_bytes", "differences", "exchange", "response_ms", "notes"})
    EXPECT_EQ(failure.value(key, json()), live.value(key, json())) << key;
}

class JudgeCommand : public CompareCommand {
 protected:
  std::string record(const std::vector<ordered_json>& vectors) {
    const TestFolder folder;
    return run_on("recorded", "emulator:xbc-h", "*", {"--vectors", write_vectors(folder, vectors)});
  }
  Finished judge(const std::string& recorded, const std::vector<ordered_json>& vectors,
                 std::vector<std::string> more = {}) {
    const TestFolder folder;
    std::vector<std::string> arguments{"judge",     recorded,
                                       "--vectors", write_vectors(folder, vectors),
                                       "--out",     folder_ / "judged"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_tool(arguments);
  }
};

TEST_F(JudgeCommand, TodaysVectorDecides) {
  const std::string recorded = record({small_vector("j/same"), small_vector("j/other")});
  ASSERT_EQ(last_run_.code, 0) << last_run_.out;
  const Finished judged =
      judge(recorded, {small_vector("j/same"), small_vector("j/other", wrong_word)});
  EXPECT_EQ(judged.code, 1) << judged.err;
  EXPECT_THAT(judged.out, HasSubstr("verdicts that changed (1)\n  xgt_cnet/j/other  PASS -> FAIL  "
                                    "data: expected 0001, got 0000\n"));
  EXPECT_EQ(verdicts(folder_ / "judged"),
            (std::map<std::string, std::string>{{"xgt_cnet/j/other", "FAIL"},
                                                {"xgt_cnet/j/same", "PASS"}}));
  expect_reports(folder_ / "judged");
}

TEST_F(JudgeCommand, WhatCannotBeReplayedIsNamed) {
  const ordered_json skipped = [] {
    ordered_json vector = small_vector("j/other_model");
    vector["models"] = {"xbm-s"};
    return vector;
  }();
  const std::string recorded =
      record({small_vector("j/gone"), small_vector("j/steps"), small_vector("j/kept"), skipped});
  ordered_json other_steps = small_vector("j/steps");
  other_steps["steps"][0]["send"] = "[ENQ st 'rSS' '01' name(%MW101) EOT BCC]";
  const Finished judged = judge(recorded, {other_steps, small_vector("j/kept"), skipped});
  EXPECT_EQ(judged.code, 0) << judged.out << judged.err;
  EXPECT_THAT(
      judged.out,
      AllOf(HasSubstr("not judged again (2)\n  xgt_cnet/j/gone: the vector is gone\n"
                      "  xgt_cnet/j/steps: the vector no longer does the same to the device"),
            HasSubstr("not executed when this was recorded: 1 SKIP or BLOCKED")));
  EXPECT_EQ(verdicts(folder_ / "judged"),
            (std::map<std::string, std::string>{{"xgt_cnet/j/gone", "INCONCLUSIVE"},
                                                {"xgt_cnet/j/kept", "PASS"},
                                                {"xgt_cnet/j/other_model", "SKIP"},
                                                {"xgt_cnet/j/steps", "INCONCLUSIVE"}}));
  EXPECT_EQ(judge(recorded, {other_steps, small_vector("j/kept")}, {"--qualify"}).code, 1);
}

TEST_F(JudgeCommand, OldRecordingsLoadAndSayWhyTheyCannotBeJudged) {
  const Finished judged = judge(stored + ".ndjson", {small_vector("old/pass")});
  EXPECT_EQ(judged.code, 4) << judged.out << judged.err;
  EXPECT_THAT(judged.out, HasSubstr("xgt_cnet/old/pass: the exchange was recorded without its "
                                    "steps, by an older version; run the case again"));
}

TEST_F(JudgeCommand, WaiversAndGateApply) {
  const std::string recorded = record({small_vector("j/fails", wrong_word)});
  const std::string waivers = folder_.write(
      "w.json",
      R"([{"id": "xgt_cnet/j/fails", "reason": "r", "owner": "o", "text": "data:", "expires": "2999-01-01"}])");
  const Finished judged =
      judge(recorded, {small_vector("j/fails", wrong_word)}, {"--waivers", waivers});
  EXPECT_EQ(judged.code, 0) << judged.out << judged.err;
  EXPECT_EQ(verdicts(folder_ / "judged").at("xgt_cnet/j/fails"), "XFAIL");
}

TEST_F(JudgeCommand, NeverOverwritesWhatItReads) {
  const std::string recorded = record({small_vector("j/one")});
  const std::string before = read_text(recorded);
  const Finished judged = run_tool({"judge", recorded, "--out", folder_ / "recorded"});
  EXPECT_EQ(judged.code, 2);
  EXPECT_THAT(judged.err, HasSubstr("would overwrite"));
  EXPECT_EQ(read_text(recorded), before);
}

TEST_F(JudgeCommand, HostileRecordingsAreSurvived) {
  const std::string whole = read_text(record({small_vector("j/one"), small_vector("j/two")}));
  const auto replaced = [&](const std::string& from, const std::string& to) {
    std::string text = whole;
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
  };
  const std::string huge = std::string(300'000, 'F') + "F";
  const std::vector<std::pair<std::string, int>> files{
      {whole.substr(0, whole.rfind("{\"end\"") - 40),
       0},                                             // cut in the middle of a line: a killed run
      {replaced("\"step\":0", "\"step\":99999"), -1},  // a step that there is not
      {replaced("\"step\":1", "\"step\":-7"), -1},
      {replaced("\"steps\":[", "\"steps\":[{},{},{},{},{},{},{},{},"), -1},
      {replaced("\"stimulus_ms\":", "\"stimulus_ms\":1e308,\"x\":"), 2},
      {replaced("\"hex\":\"", "\"hex\":\"FF "), -1},
      {replaced("\"text\":\"", "\"text\":\"<script>\\u0005\\u0000"), 0},
      {replaced("\"title\":\"", "\"title\":\"\xFF"), 2},  // no UTF-8: no JSON
      {replaced("\"hex\":\"05", "\"hex\":\"" + huge), 2}};
  for (std::size_t i = 0; i < files.size(); ++i) {
    const std::string path = folder_.write("hostile.ndjson", files[i].first);
    const Finished judged = judge(path, {small_vector("j/one"), small_vector("j/two")});
    EXPECT_TRUE(judged.code == files[i].second ||
                (files[i].second == -1 && judged.code >= 0 && judged.code <= 4))
        << "file " << i << " gave " << judged.code << '\n'
        << judged.out << judged.err;
    if (judged.code != 2) expect_reports(folder_ / "judged");
    EXPECT_THAT(judged.out, Not(HasSubstr("\x05")));
  }
}

// ---- the schema of what is written

json results_schema() {
  return json::parse(read_text(FIELDPROOF_SOURCE_DIR "/reports/results.schema.json"));
}

std::vector<std::string> schema_problems(const json& schema, const json& document) {
  return results::test::JsonSchema(schema).problems(document);
}

json schema_of(const char* definition) {
  return {{"definitions", results_schema().at("definitions")},
          {"$ref", std::string("#/definitions/") + definition}};
}

TEST_F(CompareCommand, WhatIsWrittenFollowsTheSchema) {
  run_on("written", broken("0011_for_1132"),
         "xgt_cnet/rss/refused/*:xgt_cnet/rss/two_words_refused/*:xgt_cnet/wss/*word*",
         {"--allow-write", "all", "--qualify"});
  const json document = json::parse(read_text(folder_ / "written/results.json"));
  EXPECT_THAT(schema_problems(results_schema(), document), IsEmpty());
  const Results lines = read_results(folder_ / "written/results.ndjson");
  EXPECT_THAT(schema_problems(schema_of("run"), lines.run), IsEmpty());
  EXPECT_THAT(schema_problems(schema_of("end"), lines.end), IsEmpty());
  ASSERT_FALSE(lines.cases.empty());
  for (const json& one : lines.cases)
    EXPECT_THAT(schema_problems(schema_of("case"), one), IsEmpty());
}

TEST(ResultsSchema, AnOldResultFollowsIt) {
  EXPECT_THAT(schema_problems(results_schema(), json::parse(read_text(stored + ".json"))),
              IsEmpty());
}

TEST(ResultsSchema, RefusesWhatIsNotAResult) {
  const json good = json::parse(read_text(stored + ".json"));
  const auto changed = [&](const char* pointer, const json& value) {
    json document = good;
    document[json::json_pointer(pointer)] = value;
    return schema_problems(results_schema(), document);
  };
  EXPECT_THAT(changed("/schema", 2), Not(IsEmpty()));
  EXPECT_THAT(changed("/cases/0/verdict", "OK"), Not(IsEmpty()));
  EXPECT_THAT(changed("/cases/0/verdikt", "PASS"), Not(IsEmpty()));
  EXPECT_THAT(changed("/cases/0/exchange/0/hex", "5"), Not(IsEmpty()));
  EXPECT_THAT(changed("/run/started", 7), Not(IsEmpty()));
  EXPECT_THAT(changed("/end", json::object()), Not(IsEmpty()));
  EXPECT_THAT(changed("/counts/total", -1), Not(IsEmpty()));
}

}  // namespace
}  // namespace fieldproof::tool_tests
