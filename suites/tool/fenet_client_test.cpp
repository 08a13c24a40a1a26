// The bench waits for XGT FEnet clients: the emulated one in another process, and a program in
// another language that asks what --stimulus names.
#include <gmock/gmock.h>

#include <set>

#include "harness/system/sockets/test_sockets.hpp"
#include "suites/tool/tool_files.hpp"

namespace fieldproof::tool_tests::fenet_client {
namespace {

using nlohmann::ordered_json;
using testing::HasSubstr;
using testing::StartsWith;

std::string free_port(int type) { return std::to_string(os::test::port_of(os::test::bound(type))); }

class FenetClient : public testing::Test {
 protected:
  Finished run(const std::string& filter, std::vector<std::string> more,
               const ProcessOptions& options = {}) {
    std::vector<std::string> arguments{"run",
                                       "--role",
                                       "client",
                                       "--endpoint",
                                       "listen:127.0.0.1:" + tcp + "?protocol=xgt-fenet&udp=" + udp,
                                       "--filter",
                                       filter,
                                       "--out",
                                       folder / "out"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    Finished finished = run_tool(arguments, options);
    results = read_results(folder / "out/results.ndjson");
    return finished;
  }
  Finished stimulated(const std::string& filter, const std::string& behaviour = "",
                      std::vector<std::string> more = {}) {
    ProcessOptions options;
    if (!behaviour.empty()) options.environment = {{"FIELDPROOF_CLIENT", behaviour}};
    more.insert(more.end(), {"--profile", "xbc-h", "--stimulus",
                             std::string("exec python3 ") + FIELDPROOF_SOURCE_DIR +
                                 "/suites/tool/testdata/fenet_client.py " + tcp + ' ' + udp});
    return run(filter, std::move(more), options);
  }

  TestFolder folder;
  const std::string tcp = free_port(SOCK_STREAM), udp = free_port(SOCK_DGRAM);
  Results results;
};

TEST_F(FenetClient, TheEmulatedOneInAnotherProcessAsksByItself) {
  ordered_json block{{"flag", "F92"}, {"read", "%MW100"}, {"save", "%MW120"}};
  const std::string p2p =
      folder.write("p2p.json", ordered_json{{"p2p",
                                             {{"partner", "127.0.0.1"},
                                              {"port", std::stoi(tcp)},
                                              {"blocks", ordered_json::array({block})}}}}
                                   .dump());
  block["channel"] = 1;
  const std::string profile =
      folder.write("profile.json", ordered_json{{"name", "client"},
                                                {"extends", "xbc-h"},
                                                {"timing", {{"response_max", "5s"}}},  // under load
                                                {"prepared_blocks", ordered_json::array({block})}}
                                       .dump());
  Process client({FIELDPROOF_TOOL, "emulate", "xbc-h?protocol=xgt-fenet", "--p2p", p2p});
  const Finished finished =
      run("xgt_fenet/client/schedule/f9*", {"--profile", profile, "--floor", "100ms"});
  EXPECT_EQ(finished.code, 0) << finished.out << finished.err;
  EXPECT_EQ(results.verdict("xgt_fenet/client/schedule/f92"), "PASS");
  EXPECT_EQ(results.verdict("xgt_fenet/client/schedule/f90"), "BLOCKED");
}

TEST_F(FenetClient, OneWithoutAPartnerIsSaidToReachNobody) {
  const ordered_json block{{"flag", "F92"}, {"read", "%MW100"}, {"save", "%MW120"}};
  const ordered_json p2p{{"partner", "127.0.0.1"}, {"port", std::stoi(tcp)}, {"blocks", {block}}};
  Process client({FIELDPROOF_TOOL, "emulate", "xbc-h?protocol=xgt-fenet", "-v", "--p2p",
                  folder.write("p2p.json", ordered_json{{"p2p", p2p}}.dump())});
  ASSERT_TRUE(client.wait_for("refused, or out of reach: nothing was sent"));
  client.signal(SIGINT);
  const Finished finished = client.wait();
  EXPECT_THAT(finished.out, testing::AllOf(testing::HasSubstr("  waiting     36  4C 53"),
                                           testing::Not(testing::HasSubstr("  sent  "))));
}

TEST_F(FenetClient, AProgramThatAsksWhatItIsToldPasses) {
  const Finished finished = stimulated(
      "xgt_fenet/client/read/single*:*/client/read/areas_*:*/client/read/continuous_word:"
      "*/client/write/areas_*:*/client/connection/*_channels:*/client/connection/kept:"
      "xgt_fenet/client/udp/w*:xgt_fenet/client/write/single/word");
  EXPECT_EQ(finished.code, 0) << finished.out << finished.err;
  EXPECT_GE(results.counts()["PASS"], 10u)
      << finished.out;  // of the rest nobody reads what is saved
  EXPECT_EQ(results.verdict("xgt_fenet/client/udp/write"), "PASS");
}

TEST_F(FenetClient, OneThatErrsIsCaughtOnTheWire) {
  EXPECT_EQ(stimulated("xgt_fenet/client/write/single/word", "big_endian").code, 1);
  EXPECT_THAT(results.of("xgt_fenet/client/write/single/word").at("message").get<std::string>(),
              StartsWith("data: expected"));
}

/// Who takes what is no reply asks for the next block, and the wire shows that.
TEST_F(FenetClient, AReplyThatWasTakenWronglyShowsInTheNextRequest) {
  const std::string wrong = "xgt_fenet/client/seen/wrong_invoke",
                    previous = "xgt_fenet/client/seen/previous_reply";
  EXPECT_EQ(stimulated(wrong + ':' + previous).code, 0);
  EXPECT_EQ(results.counts()["PASS"], 2u);
  for (const auto& [behaviour, caught] :
       {std::pair<std::string, std::set<std::string>>{"any_id", {wrong, previous}},
        {"no_count", {previous}}}) {
    EXPECT_EQ(stimulated(wrong + ':' + previous, behaviour).code, 1);
    for (const std::string& id : {wrong, previous})
      EXPECT_EQ(results.verdict(id), caught.contains(id) ? "FAIL" : "PASS") << behaviour << id;
  }
}

/// Words that nobody has looked at: no check of them is a verdict.
TEST_F(FenetClient, WhatIsInItsMemoryIsNotJudged) {
  const Finished finished = stimulated(
      "xgt_fenet/client/limits/registers/*:*/client/limits/flags/*:*/client/errors/wrong_invoke:"
      "xgt_fenet/client/read/save_areas/*");
  EXPECT_EQ(results.counts()["PASS"], 0u) << finished.out;
  EXPECT_GE(results.counts()["INCONCLUSIVE"], 10u);
  EXPECT_EQ(stimulated("xgt_fenet/client/limits/registers/*", "", {"--qualify"}).code, 1);
}

}  // namespace
}  // namespace fieldproof::tool_tests::fenet_client
