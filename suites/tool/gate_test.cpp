// The gate says what it judged: coverage in headline and exit code, and a case of JUnit for each
// reason that makes the exit code not 0.
#include <gmock/gmock.h>

#include <csignal>
#include <regex>

#include "suites/tool/tool_files.hpp"

namespace fieldproof::tool_tests {
namespace {

using nlohmann::ordered_json;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

const std::string good_device =
    "exec:/usr/bin/python3 " FIELDPROOF_SOURCE_DIR "/suites/tool/testdata/device.py good {tty}";

ordered_json writing(const std::string& id) {
  ordered_json vector = small_vector(id, "[ACK st 'wSS' ETX BCC]");
  vector["steps"][0]["send"] = "[ENQ st 'wSS' '01' name(%MW100) '1234' EOT BCC]";
  return vector;
}

/// What needs something that no bench of these tests has.
ordered_json unjudged(const std::string& id) {
  ordered_json vector = small_vector(id);
  vector["steps"] = {{{"do", "explode"}}};
  return vector;
}

class Gate : public testing::Test {
 protected:
  Finished run(const std::vector<ordered_json>& vectors, std::vector<std::string> more = {}) {
    std::vector<std::string> arguments{"run", "--vectors", write_vectors(folder_, vectors), "--out",
                                       folder_ / "out"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_tool(arguments);
  }
  /// One that is to be ended from outside.
  Process long_run() {
    return Process(
        tool_arguments({"run", "--duration", "60s", "--vectors",
                        write_vectors(folder_, {small_vector("g/a")}), "--out", folder_ / "out"}));
  }
  Results results() const { return read_results(folder_ / "out/results.ndjson"); }

  /// The message of the test case that JUnit has for a reason; empty: there is none.
  std::string junit_says(const std::string& reason, const char* element = "failure") const {
    Junit junit;
    read_junit(folder_ / "out/junit.xml", junit);
    return junit.cases["fieldproof.gate " + reason].child(element).attribute("message").value();
  }

  TestFolder folder_;
};

TEST_F(Gate, HeadlineSaysHowMuchWasJudged) {
  const Finished finished = run({small_vector("g/a"), small_vector("g/b"), unjudged("g/c"),
                                 with(small_vector("g/d"), "models", {"xec-h"})},
                                {"--endpoint", "emulator:xbc-h"});
  EXPECT_EQ(finished.code, 0);
  EXPECT_THAT(finished.out, HasSubstr("exit 0: gate met: 2 of 3 judged\n"))
      << "what the profile does not declare is not asked for";
  expect_reports(folder_ / "out");
}

TEST_F(Gate, TooLittleJudgedIsRed) {
  const std::vector<ordered_json> vectors{small_vector("g/a"), small_vector("g/b"),
                                          unjudged("g/c")};
  EXPECT_EQ(run(vectors, {"--min-judged", "66%"}).code, 0);
  const Finished finished = run(vectors, {"--min-judged", "67%"});
  EXPECT_EQ(finished.code, 1);
  EXPECT_THAT(finished.out,
              HasSubstr("exit 1: too little judged: 2 of 3 judged (66.7%), --min-judged asks for "
                        "67%\n"));
  EXPECT_THAT(junit_says("min-judged"), HasSubstr("2 of 3 judged"));
  expect_reports(folder_ / "out");
  const Finished again = run_tool({"judge", folder_ / "out/results.ndjson", "--vectors",
                                   folder_ / "vectors", "--out", folder_ / "again"});
  EXPECT_EQ(again.code, 1) << "a recorded run is judged by the gate that it had\n" << again.out;
  for (const char* wrong : {"0", "101%", "most", "%"}) {
    const Finished refused = run(vectors, {"--min-judged", wrong});
    EXPECT_EQ(refused.code, 2) << wrong;
    EXPECT_THAT(refused.err, HasSubstr("is no share; write 90%"));
  }
}

/// A green gate that judged a tenth of the cases is a lie where it does not say so.
TEST_F(Gate, LessThanHalfJudgedIsSaidLoudly) {
  const Finished finished = run({small_vector("g/a"), unjudged("g/b"), unjudged("g/c")});
  EXPECT_EQ(finished.code, 0);
  EXPECT_THAT(finished.out,
              AllOf(HasSubstr("exit 0: gate met by less than half: 1 of 3 judged (33.3%); "
                              "--min-judged says how much is enough"),
                    Not(HasSubstr("gate met: "))));
  expect_reports(folder_ / "out");
  EXPECT_THAT(run({small_vector("g/a"), unjudged("g/b")}).out,
              HasSubstr("exit 0: gate met: 1 of 2 judged\n"));
}

TEST_F(Gate, NotQualifiedIsNoFailureOfTheDevice) {
  const Finished finished = run({small_vector("g/a"), unjudged("g/b")}, {"--qualify"});
  EXPECT_EQ(finished.code, 1);
  EXPECT_THAT(finished.out, AllOf(HasSubstr("exit 1: not qualified: 1 not judged\n"),
                                  Not(HasSubstr("conformance failed"))));
  EXPECT_EQ(junit_says("qualify"), "not qualified: 1 not judged");
  expect_reports(folder_ / "out");
}

/// A program that the bench starts is nobody's plant.
TEST_F(Gate, AProgramMayBeWrittenUnlessThatIsForbidden) {
  const std::vector<std::string> device{"--endpoint", good_device, "--profile", "xbc-h"};
  const auto run_device = [&](std::vector<std::string> more) {
    more.insert(more.end(), device.begin(), device.end());
    return run({small_vector("g/read"), writing("g/write")}, more);
  };
  const Finished open = run_device({});
  EXPECT_NE(results().verdict("xgt_cnet/g/write"), "BLOCKED");
  EXPECT_THAT(open.out, HasSubstr("writes=anywhere: the device ends with the run"));
  const Finished closed = run_device({"--read-only"});
  EXPECT_EQ(results().verdict("xgt_cnet/g/write"), "BLOCKED");
  EXPECT_THAT(closed.out, Not(HasSubstr("writes=anywhere")));
  EXPECT_THAT(closed.out, HasSubstr("with --allow-write M0-M199: 1 more"));
  EXPECT_EQ(results().end.at("hint"), "with --allow-write M0-M199: 1 more");
  run_device({"--allow-write", "D0-D9"});
  EXPECT_EQ(results().verdict("xgt_cnet/g/write"), "BLOCKED") << "an explicit range narrows it";
  EXPECT_EQ(run_device({"--read-only", "--allow-write", "M"}).code, 2);
}

TEST_F(Gate, JunitOfAKilledRunIsRed) {
  Process process(long_run());
  ASSERT_TRUE(process.wait_for("fieldproof "));
  process.signal(SIGKILL);
  process.wait();
  const Finished report = run_tool(
      {"report", folder_ / "out/results.ndjson", "--junit", folder_.write("out/junit.xml", "")});
  EXPECT_EQ(report.code, 0) << report.err;
  EXPECT_THAT(junit_says("killed", "error"), HasSubstr("the run was killed"));
}

TEST_F(Gate, JunitOfAnInterruptedRunIsRed) {
  Process process(long_run());
  ASSERT_TRUE(process.wait_for("fieldproof "));
  process.signal(SIGINT);
  EXPECT_EQ(process.wait().code, 130);
  EXPECT_EQ(junit_says("interrupted", "error"), "interrupted");
}

TEST_F(Gate, MissingShardsAreAnErrorInJunit) {
  const std::vector<std::string> arguments{
      "run", "--vectors", write_vectors(folder_, many_vectors(4)), "--out", folder_ / "shard"};
  ASSERT_EQ(
      run_tool(arguments, {{{"GTEST_TOTAL_SHARDS", "2"}, {"GTEST_SHARD_INDEX", "0"}}, {}}).code, 0);
  const Finished merged =
      run_tool({"merge", folder_ / "shard/results.ndjson", "--out", folder_ / "out"});
  EXPECT_EQ(merged.code, 3);
  EXPECT_THAT(junit_says("trouble", "error"), HasSubstr("missing"));
  expect_reports(folder_ / "out");
}

/// What cannot be written is trouble: on the terminal, in the exit code that is printed, and in
/// JUnit.
TEST_F(Gate, AReportThatCannotBeWrittenIsTroubleEverywhere) {
  const std::string html = folder_.write("file", "") + "/report.html";
  const Finished finished = run({small_vector("g/a", wrong_word)}, {"--html", html});
  EXPECT_EQ(finished.code, 3) << "goes before a failure";
  EXPECT_THAT(finished.err, HasSubstr("cannot write " + html));
  EXPECT_THAT(finished.out, HasSubstr("exit 3: cannot write " + html));
  EXPECT_THAT(junit_says("report", "error"), HasSubstr(html));
}

TEST_F(Gate, AStaleGlobWaiverIsRed) {
  std::vector<ordered_json> vectors{unjudged("g/never")};
  for (int i = 0; i < 12; ++i) vectors.push_back(small_vector("g/n" + std::to_string(i)));
  const std::string waivers = folder_.write("waivers.json", R"([
      {"id": "xgt_cnet/g/*", "reason": "was a fault", "owner": "bench", "text": "data:",
       "expires": "2999-01-01"}])");
  const Finished finished = run(vectors, {"--waivers", waivers});
  EXPECT_EQ(finished.code, 1) << finished.out;
  EXPECT_THAT(finished.out, HasSubstr("none of the 12 cases that xgt_cnet/g/* covers"));
  expect_reports(folder_ / "out");
}

TEST_F(Gate, ABaselineSaysThatThisRunCameToItsEnd) {
  ASSERT_EQ(run({small_vector("g/a"), small_vector("g/b")}).code, 0);
  const std::string old = folder_ / "old.ndjson";
  std::filesystem::copy(folder_ / "out/results.ndjson", old);
  const Finished same = run({small_vector("g/a"), small_vector("g/b")}, {"--baseline", old});
  EXPECT_EQ(same.code, 0) << same.out;
  EXPECT_THAT(same.out, Not(HasSubstr("came to its end")));
  const Finished worse = run({small_vector("g/a"), unjudged("g/b")}, {"--baseline", old});
  EXPECT_EQ(worse.code, 1) << worse.out;
  EXPECT_THAT(worse.out, HasSubstr("exit 1: worse than " + old));
  EXPECT_THAT(junit_says("baseline"), HasSubstr("worse than " + old));
}

TEST_F(Gate, CompareCountsWhatWasNotJudgedAsSkipped) {
  run({small_vector("g/a"), unjudged("g/b"), with(small_vector("g/c"), "models", {"xec-h"})},
      {"--endpoint", "emulator:xbc-h"});
  const std::string results = folder_ / "out/results.ndjson";
  const Finished finished =
      run_tool({"compare", results, results, "--junit", folder_ / "compare.xml"});
  EXPECT_EQ(finished.code, 0) << finished.out << finished.err;
  Junit junit;
  read_junit(folder_ / "compare.xml", junit);
  EXPECT_EQ(junit.tests, 3u);
  EXPECT_EQ(junit.skipped, 2u);
  EXPECT_EQ(junit.with("skipped"), 2u);
  expect_valid_junit(folder_ / "compare.xml");
}

TEST_F(Gate, MaxFailuresEndsTheRun) {
  std::vector<ordered_json> vectors;
  for (int i = 0; i < 9; ++i)
    vectors.push_back(small_vector("g/n" + std::to_string(i), i > 0 ? wrong_word : zero_word));
  const Finished finished = run(vectors, {"--max-failures", "3"});
  EXPECT_EQ(finished.code, 1);
  const std::map<std::string, std::size_t> expected{{"PASS", 1}, {"FAIL", 3}, {"BLOCKED", 5}};
  EXPECT_EQ(results().counts(), expected);
  EXPECT_EQ(results().of("xgt_cnet/g/n8").at("message"), "not run: --max-failures 3 was reached");
  expect_reports(folder_ / "out");
}

TEST_F(Gate, AFilterOfOneProtocolChoosesIt) {
  const std::string profile = folder_.write(
      "p.json", R"({"name": "p", "model": "xbc-h", "protocols": ["modbus-rtu", "xgt-cnet"]})");
  const std::vector<std::string> device{"--endpoint", good_device, "--profile", profile};
  const auto run_device = [&](std::vector<std::string> more) {
    more.insert(more.end(), device.begin(), device.end());
    return run({small_vector("g/read")}, more);
  };
  EXPECT_EQ(run_device({}).code, 0) << "all cases are of xgt-cnet";
  EXPECT_EQ(results().verdict("xgt_cnet/g/read"), "PASS");
  EXPECT_EQ(run_device({"--protocol", "xgt-cnet"}).code, 0);
  EXPECT_EQ(run_device({"--protocol", "modbus-rtu", "--dry-run"}).code, 0);
  EXPECT_EQ(run_device({"--protocol", "modbus"}).code, 2);
}

TEST_F(Gate, WhatIsWrongBeforeAByteIsSentIsUsage) {
  const auto refused = [&](const std::vector<std::string>& arguments, const std::string& why,
                           const ProcessOptions& options = {}) {
    std::vector<std::string> all{"run", "--vectors", write_vectors(folder_, {small_vector("g/a")}),
                                 "--out", folder_ / "out"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    const Finished finished = run_tool(all, options);
    EXPECT_EQ(finished.code, 2) << finished.out;
    EXPECT_THAT(finished.err, AllOf(testing::StartsWith("fieldproof: "), HasSubstr(why)));
  };
  refused(
      {"--profile",
       folder_.write("p.json", R"({"name": "p", "model": "xbc-hh", "protocols": ["xgt-cnet"]})")},
      "no case is for the model 'xbc-hh'");
  refused({"--endpoint", "emulator:" + folder_.path() + "/none.json"}, "cannot read ");
  refused({"--endpoint", "emulator:" + folder_.write("broken.json", R"({"frames": )")},
          "broken.json");
  refused({}, "is no shard", {{{"GTEST_TOTAL_SHARDS", "2"}, {"GTEST_SHARD_INDEX", "2"}}, {}});
  refused({"--floor", "2"}, "--floor: '2' is no duration");
  for (const auto& [endpoint, why] :
       {std::pair{"serial:/dev/null?frame=9N1", "the data bits are not 7 or 8"},
        {"serial:/dev/null?baud=fast", "the speed is not one of the eight"},
        {"serial:/dev/null?rs485=2", "rs485 is '2'; write 1"},
        {"rfc2217:nowhere:1?frame=8X1", "cannot open rfc2217:nowhere:1"},
        {"tcp:nowhere:1?floor_ms=x", "floor_ms is 'x'"},
        {"emulator:xbc-h?line=9600-9N1", "the data bits are not 7 or 8"},
        {"emulator:xbc-h?protocol=xgt-cnet&colour=1", "there is no key 'colour'"},
        {"pty:xbc-h?protocol=xgt-cnet&mode=runn", "mode is 'runn', which is not run or stop"}})
    refused({"--endpoint", endpoint, "--profile", "xbc-h"}, why);
  for (const char* beside : {"--aux", "--loop"})
    refused({"--endpoint", good_device, "--profile", "xbc-h", beside, "serial:/dev/null?frame=9N1"},
            std::string(beside) +
                ": cannot open serial:/dev/null: cannot read line settings "
                "'9600-9N1': the data bits are not 7 or 8");
  refused({"--endpoint", good_device, "--profile", "xbc-h", "--allow-write", ""},
          "--allow-write needs a range");
  refused({"--endpoint", good_device, "--profile",
           folder_.write("bases.json",
                         R"({"name": "p", "model": "xbc-h", "protocols": ["modbus-rtu"],
                             "config": {"bit_read_base": "Q9"}})")},
          "cannot use profile p: cannot place bit_read_base 'Q9' on xbc-h");
  refused({"--endpoint", good_device, "--profile",
           folder_.write("keys.json",
                         R"({"name": "p", "model": "xbc-h", "protocols": ["modbus-rtu"],
                             "config": {"word_reed_base": "D0"}})")},
          "keys.json: unknown key config.word_reed_base; did you mean 'word_read_base'?");
}

/// The recipes of the README as they are printed, with a good device in the place of ./my_plc.
TEST(Readme, RecipesPassAsPrinted) {
  const std::string readme = read_text(FIELDPROOF_SOURCE_DIR "/README.md");
  const std::regex recipe(R"re(run --endpoint "exec:\./my_plc \{tty\}"([^\n']*))re");
  std::vector<std::string> options;
  for (std::sregex_iterator one(readme.begin(), readme.end(), recipe), end; one != end; ++one)
    options.push_back((*one)[1]);
  ASSERT_GE(options.size(), 2u) << "Jenkins, Slurm; those of GitLab and GitHub are in recipes_test";
  for (const std::string& one : options)
    EXPECT_THAT(one, HasSubstr("--min-judged 90%")) << "the recipe of a gate says what it judges";
  const TestFolder folder;
  const Finished finished =
      run_program({"/bin/sh", "-c",
                   std::string(FIELDPROOF_TOOL " run --endpoint \"exec:" FIELDPROOF_TOOL
                                               " emulate xbc-h --pty {tty}\"") +
                       options.front() + " --out " + folder.path()});
  EXPECT_EQ(finished.code, 0) << finished.out << finished.err;
  EXPECT_THAT(finished.out, HasSubstr("exit 0: gate met: "));
}

}  // namespace
}  // namespace fieldproof::tool_tests
