// Programs that take the lines of --stimulus literally (testdata/literal_client.py), against the
// vectors of the project: a device is blamed for nothing that it was not told.
#include <gmock/gmock.h>

#include "reports/results/test_json_schema.hpp"
#include "suites/tool/tool_files.hpp"

namespace fieldproof::tool_tests {
namespace {

using nlohmann::json;
using testing::AnyOf;
using testing::HasSubstr;
using testing::IsEmpty;

class LiteralClient : public testing::Test {
 protected:
  Finished run(const std::string& kind, const std::string& filter,
               std::vector<std::string> more = {}) {
    std::vector<std::string> arguments{
        "run",
        "--role",
        "client",
        "--filter",
        filter,
        "--out",
        folder / "out",
        "--profile",
        profile,
        "--stimulus",
        "-",
        "--endpoint",
        "exec:python3 " FIELDPROOF_SOURCE_DIR "/suites/tool/testdata/literal_client.py {tty} " +
            kind + " " + log() + "?floor_ms=400"};  // a busy machine delays clocks
    arguments.insert(arguments.end(), more.begin(), more.end());
    Finished finished = run_tool(arguments, {});
    results = read_results(folder / "out/results.ndjson");
    return finished;
  }
  std::string log() const { return folder / "lines"; }
  /// On a busy machine Python may think for seconds.
  std::string patient() {
    return folder.write(
        "patient.json",
        R"({"extends": "xbc-h", "name": "patient", "timing": {"response_max": "3s"}})");
  }
  std::vector<json> lines() const {
    std::vector<json> all;
    std::istringstream text(read_text(log()));
    for (std::string line; std::getline(text, line);) all.push_back(json::parse(line));
    return all;
  }

  TestFolder folder;
  std::string profile = "xbc-h";
  Results results;
};

/// STOP, link enable, channels, clocks, a bit that a service saves: all of it is told.
TEST_F(LiteralClient, WhoFollowsAllHasNothingBlockedAndNothingFailed) {
  profile = patient();
  const Finished finished = run("well", "xgt_cnet/client/schedule/*");
  EXPECT_EQ(finished.code, 0) << finished.out << finished.err;
  for (const json& one : results.cases)
    EXPECT_THAT(one.at("verdict"), AnyOf("PASS", "INFO", "INCONCLUSIVE", "SKIP"))
        << one.at("id") << ' ' << one.value("message", "");
  for (const char* id :
       {"link_off", "link_never_enabled/bit", "link_never_enabled/clock", "channel/one",
        "channel/two", "block_fired_by_saved_bit", "stop_with_clock", "slow_partner"})
    EXPECT_EQ(results.verdict(std::string("xgt_cnet/client/schedule/") + id), "PASS") << id;
}

TEST_F(LiteralClient, EveryLineFollowsTheSchema) {
  EXPECT_EQ(run("well", "xgt_cnet/client/schedule/link_off:xgt_cnet/client/schedule/slow_partner",
                {"--repeat", "2"})
                .code,
            0);
  const results::test::JsonSchema schema(
      json::parse(read_text(FIELDPROOF_SOURCE_DIR "/vectors/stimulus.schema.json")));
  std::set<std::string> kinds;
  std::set<int> numbers;
  for (const json& line : lines()) {
    EXPECT_THAT(schema.problems(line), IsEmpty()) << line.dump();
    for (const char* kind : {"hello", "begin", "block", "set", "do", "over", "probe"})
      if (line.contains(kind)) kinds.insert(kind);
    if (line.contains("number")) numbers.insert(line.at("number").get<int>());
  }
  EXPECT_EQ(kinds.size(), 7u) << "every kind of line was there";
  EXPECT_EQ(numbers.size(), 6u) << "two cases twice, and the probes before and after them";
  EXPECT_THAT(schema.problems({{"case", "c"}, {"over", false}}), testing::Not(IsEmpty()));
}

TEST_F(LiteralClient, WhoDeclaresTheMinimumIsAskedForNoMore) {
  profile = patient();
  const Finished finished = run("minimum", "xgt_cnet/client/schedule/*:xgt_cnet/client/read/*");
  EXPECT_EQ(finished.code, 0) << finished.out << finished.err;
  for (const json& one : results.cases)
    EXPECT_THAT(one.at("verdict"), AnyOf("PASS", "INFO", "INCONCLUSIVE", "SKIP"))
        << one.at("id") << ' ' << one.value("message", "");
  for (const char* id : {"link_off", "channel/one", "block_fired_by_saved_bit"})
    EXPECT_EQ(results.verdict(std::string("xgt_cnet/client/schedule/") + id), "SKIP") << id;
  EXPECT_EQ(results.of("xgt_cnet/client/schedule/link_off").at("message"),
            "needs 'link', which the program of --stimulus does not declare to follow (README, "
            "\"The module as client\")");
  EXPECT_EQ(results.verdict("xgt_cnet/client/schedule/block_order"), "PASS");
}

TEST_F(LiteralClient, WhoSaysNothingIsToldNoMoreThanWhatToAsk) {
  EXPECT_EQ(run("undeclared", "xgt_cnet/client/schedule/block_order").code, 0);
  const std::vector<json> told = lines();
  ASSERT_GT(told.size(), 3u);
  for (const json& line : told) EXPECT_TRUE(line.contains("hello") || line.contains("block"));
  EXPECT_EQ(told.at(1).value("probe", false), true);
  EXPECT_EQ(told.at(4).at("block").at("block"), 1);
  EXPECT_EQ(told.at(4).at("last"), false);
  EXPECT_EQ(told.at(6).at("last"), true);
}

/// A request that is not answered, and a look just before and behind its time-out.
TEST_F(LiteralClient, HowExactlyATimeOutIsKeptIsNotJudged) {
  profile = patient();
  const std::string exact = "xgt_cnet/client/time_out/exact/n1";
  run("well", exact + ":xgt_cnet/client/time_out/late_answer_of_another_block");
  EXPECT_EQ(results.verdict(exact), "INCONCLUSIVE");
  EXPECT_THAT(results.of(exact).at("message").get<std::string>(),
              testing::HasSubstr("acts within 50 ms of the client's time-out"));
  EXPECT_THAT(results.of("xgt_cnet/client/time_out/late_answer_of_another_block").dump(),
              testing::Not(testing::HasSubstr("acts within")));
}

/// Cnet EN 7.1.3: capitals or small letters tell main commands apart, 'but not for the others'.
TEST_F(LiteralClient, SmallLettersAreAnAllowedAlternative) {
  EXPECT_EQ(run("small", "xgt_cnet/client/schedule/block_order").code, 0);
  EXPECT_EQ(results.verdict("xgt_cnet/client/schedule/block_order"), "NON-STRICT");
}

/// Of the digits of an LS Bus request no manual says the case.
TEST_F(LiteralClient, SmallDigitsOfTheLsBusAreAnAllowedAlternative) {
  profile = folder.write("ls.json", R"({"extends": "xbc-h", "name": "ls", "protocols": ["ls-bus"],
                                       "config": {"write_order": "address_first"}})");
  const char* const cases =
      "ls_bus/client/example/read:ls_bus/client/example/write_address_first:"
      "ls_bus/client/schedule/block_order";
  for (const auto& [kind, verdict] : {std::pair{"ls_bus", "PASS"}, {"ls_small", "NON-STRICT"}}) {
    const Finished finished = run(kind, cases);
    EXPECT_EQ(finished.code, 0) << finished.out << finished.err;
    for (const json& one : results.cases) EXPECT_EQ(one.at("verdict"), verdict) << one.at("id");
    EXPECT_EQ(results.cases.size(), 3u);
  }
}

/// It ends where it hears a request: nobody polls a client, not even after a power cycle.
TEST_F(LiteralClient, IsAskedNothingItself) {
  const Finished finished =
      run("well", "xgt_cnet/client/*power*:xgt_cnet/client_monitor/*:xgt_cnet/client/monitor*");
  EXPECT_EQ(finished.code, 0) << finished.out << finished.err;
  EXPECT_GE(results.counts()["PASS"], 2u);
  for (const json& one : results.cases) {
    EXPECT_THAT(one.value("message", ""), testing::Not(HasSubstr("polled"))) << one.at("id");
    EXPECT_NE(one.at("verdict"), "BLOCKED") << one.dump();
  }
}

TEST_F(LiteralClient, PipeliningIsCalledSo) {
  EXPECT_EQ(run("pipelines", "xgt_cnet/client/schedule/block_order").code, 1);
  EXPECT_THAT(results.of("xgt_cnet/client/schedule/block_order").at("message").get<std::string>(),
              HasSubstr("pipelining: the request came too early"));
}

/// One that waits out its time-out, as it says, is not blamed in the cases that follow.
TEST_F(LiteralClient, ATimeOutThatIsDeclaredIsWaitedOut) {
  const Finished finished =
      run("patient", "xgt_cnet/client/error/partner/*:xgt_cnet/client/schedule/block_order");
  EXPECT_EQ(finished.code, 0) << finished.out << finished.err;
  EXPECT_EQ(results.verdict("xgt_cnet/client/schedule/block_order"), "PASS");
  for (const json& one : results.cases)  // what is saved, and flags, nobody reads there
    EXPECT_THAT(one.at("verdict"), AnyOf("PASS", "INCONCLUSIVE", "SKIP")) << one.dump();
}

TEST_F(LiteralClient, WhoGivesUpFailsAndIsStartedAgain) {
  const Finished finished =
      run("gives_up", "xgt_cnet/client/schedule/block_order:xgt_cnet/client/run/*");
  EXPECT_EQ(finished.code, 1) << finished.out << finished.err;
  std::size_t gave_up = 0;
  for (const json& one : results.cases)
    gave_up += one.at("verdict") == "FAIL" &&
               one.value("message", "").find("exit status 1") != std::string::npos;
  EXPECT_GE(gave_up, 1u);
}

}  // namespace
}  // namespace fieldproof::tool_tests
