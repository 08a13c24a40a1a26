// The bench in the partner's chair: the emulated client, programs that ask when told, a PLC with
// blocks prepared.
#include <gmock/gmock.h>

#include "suites/tool/tool_files.hpp"

namespace fieldproof::tool_tests {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;
using testing::HasSubstr;

constexpr const char* ask_m100 = "[ENQ '02' 'rSS' '01' name(%MW100) EOT BCC]";
constexpr const char* ask_m101 = "[ENQ '02' 'rSS' '01' name(%MW101) EOT BCC]";

const ordered_json read_block{
    {"flag", "%MX00000"}, {"read", "%MW100"}, {"save", "%MW200"}, {"station", 2}};

ordered_json partner(const std::string& fault = "none") {
  return {{"station", 2}, {"memory", {{"%MW100", "5ABC"}, {"%MW101", "6BCD"}}}, {"fault", fault}};
}

ordered_json client_case(const std::string& id, const ordered_json& blocks,
                         const ordered_json& steps) {
  ordered_json vector = small_vector("client/" + id);
  vector["given"]["config"] = {{"station", 0}, {"role", "client"}, {"p2p", {{"blocks", blocks}}}};
  vector["steps"] = steps;
  return vector;
}

ordered_json read_case(const std::string& fault, const std::string& status) {
  return client_case("read/" + fault, ordered_json::array({read_block}),
                     {{{"set", {{"%MX00000", "01"}}}},
                      {{"expect", ask_m100}, {"partner", partner(fault)}},
                      {{"wait", "1s"}},
                      {{"check",
                        {{"%LW512", status == "0000" ? "0001" : "0002"},
                         {"%LW513", status},
                         {"%MW200", status == "0000" ? "5ABC" : "0000"}}}}});
}

ordered_json cadence_case() {
  return client_case(
      "cadence", ordered_json::array({with(read_block, "flag", "F92")}),
      {{{"expect", ask_m100}, {"partner", partner()}, {"every", "200ms"}, {"times", 5}}});
}

ordered_json write_case() {
  ordered_json vector =
      client_case("write",
                  {{{"function", "write"},
                    {"flag", "%MX00000"},
                    {"read", "%MW100"},
                    {"save", "%MW300"},
                    {"station", 2}}},
                  {{{"set", {{"%MX00000", "01"}}}},
                   {{"expect", "[ENQ '02' 'wSS' '01' name(%MW300) '1234' EOT BCC]"}},
                   {{"partner", partner()}}});
  vector["given"]["memory"] = {{"%MW100", "1234"}};
  return vector;
}

class ClientRole : public testing::Test {
 protected:
  Finished run(const std::vector<ordered_json>& vectors, std::vector<std::string> more,
               const ProcessOptions& options = {}) {
    std::vector<std::string> arguments{
        "run",   "--role",      "client", "--vectors", write_vectors(folder, vectors),
        "--out", folder / "out"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    Finished finished = run_tool(arguments, options);
    results = read_results(folder / "out/results.ndjson");
    return finished;
  }
  std::string profile(const ordered_json& blocks = ordered_json::array()) {
    return folder.write(
        "profile.json",
        ordered_json{{"name", "client"}, {"extends", "xbc-h"}, {"prepared_blocks", blocks}}.dump());
  }
  static std::string script() { return FIELDPROOF_SOURCE_DIR "/suites/tool/testdata/client.py"; }
  static std::string program() { return "exec:python3 " + script() + " {tty}"; }

  TestFolder folder;
  Results results;
};

/// What each fault does to an XGT client: the codes of Cnet EN Appendix 3.3.
TEST_F(ClientRole, EveryFaultOfThePartnerHasItsErrorCode) {
  const std::map<std::string, std::string> codes{
      {"none", "0000"},       {"wrong_station", "0004"}, {"wrong_check", "0003"}, {"nak", "000F"},
      {"wrong_head", "0001"}, {"wrong_tail", "0002"},    {"short", "000B"},       {"long", "000B"},
      {"not_hex", "000D"},    {"late", "000A"},          {"never", "000A"},       {"echo", "0001"},
      {"garbage", "0001"}};
  std::vector<ordered_json> vectors;
  for (const auto& [fault, code] : codes) vectors.push_back(read_case(fault, code));
  EXPECT_EQ(run(vectors, {}).code, 0);
  for (const json& one : results.cases)
    EXPECT_EQ(one.at("verdict"), "PASS") << one.at("id") << one.value("message", "");
  EXPECT_EQ(results.cases.size(), codes.size());
}

TEST_F(ClientRole, LateIsOneCharacterPastTheTimeOut) {
  run({read_case("late", "000A")}, {});
  const json exchange = results.of("xgt_cnet/client/read/late").at("exchange");
  double asked = 0, answered = 0;
  for (const json& event : exchange) {
    if (event.at("kind") == "received") asked = event.at("end_ms");
    if (event.at("kind") == "sent") answered = event.at("start_ms");
  }
  EXPECT_NEAR(answered - asked, 200 + 10 / 9.6, 1e-3) << exchange.dump(1);
}

TEST_F(ClientRole, AnswersOfOtherRequestsComeBack) {
  const ordered_json second{
      {"flag", "%MX00001"}, {"read", "%MW101"}, {"save", "%MW201"}, {"station", 2}};
  const auto steps = [](const std::string& fault) -> ordered_json {
    return {{{"set", {{"%MX00000", "01"}}}},
            {{"expect", ask_m100}, {"partner", partner()}},
            {{"wait", "100ms"}},
            {{"set", {{"%MX00001", "01"}}}},
            {{"expect", ask_m101}, {"partner", partner(fault)}},
            {{"wait", "500ms"}},
            {{"check", {{"%MW201", "5ABC"}}}}};
  };
  const auto blocks = ordered_json::array({read_block, second});
  EXPECT_EQ(run({client_case("previous", blocks, steps("previous")),
                 client_case("other_block", blocks, steps("other_block"))},
                {})
                .code,
            0);
}

TEST_F(ClientRole, ACadenceIsExactInSimulatedTimeAndNoted) {
  EXPECT_EQ(run({cadence_case()}, {}).code, 0);
  EXPECT_THAT(
      results.of("xgt_cnet/client/cadence").at("notes").dump(),
      HasSubstr("every 200 ms: measured min 200.000, median 200.000, max 200.000 ms of 4 periods"));
  ordered_json slower = cadence_case();
  slower["steps"][0]["every"] = "202ms";
  EXPECT_EQ(run({slower}, {}).code, 1) << "2 ms are two characters";
}

/// What is in its memory is not: nobody has looked, and that passes nothing.
TEST_F(ClientRole, AStimulatedProgramIsJudgedOnTheWire) {
  EXPECT_EQ(run({read_case("none", "0000"), write_case()},
                {"--endpoint", program(), "--stimulus", "-", "--profile", profile()})
                .code,
            0);
  EXPECT_EQ(results.verdict("xgt_cnet/client/write"), "PASS");
  EXPECT_EQ(results.verdict("xgt_cnet/client/read/none"), "INCONCLUSIVE");
  EXPECT_THAT(results.of("xgt_cnet/client/read/none").at("message").get<std::string>(),
              HasSubstr("%LW512, %LW513, %MW200 could not be read; give --aux"));
  const Finished judged = run_tool({"judge", folder / "out/results.ndjson", "--profile", profile(),
                                    "--vectors", folder / "vectors", "--out", folder / "judged"});
  EXPECT_EQ(judged.code, 0) << judged.out << judged.err;
  EXPECT_EQ(read_results(folder / "judged/results.ndjson").counts(), results.counts());
  EXPECT_THAT(read_text(folder / "judged/results.ndjson"), HasSubstr("could not be read"));
}

/// Exactly how often is for the machine to say that it runs on.
TEST_F(ClientRole, TheCadenceOfAStimulatedProgramIsMeasured) {
  run({cadence_case()}, {"--endpoint", program(), "--stimulus", "-", "--profile", profile()});
  const json measured = results.of("xgt_cnet/client/cadence");
  EXPECT_THAT(measured.at("notes").dump(),
              testing::ContainsRegex("every 200 ms: measured min .* of 4 periods"));
}

/// A clock is a period with a tolerance, no time-out: 0.4 ms more are none too many.
TEST_F(ClientRole, AClockIsJudgedByItsPeriod) {
  for (const auto& [seconds, verdict] : {std::pair{"0.2004", "PASS"}, {"0.4", "FAIL"}}) {
    run({cadence_case()},
        {"--endpoint", program() + "?floor_ms=120", "--stimulus", "-", "--profile", profile()},
        {{{"FIELDPROOF_PERIOD", seconds}}, ""});
    EXPECT_EQ(results.verdict("xgt_cnet/client/cadence"), verdict) << seconds;
  }
  EXPECT_THAT(results.of("xgt_cnet/client/cadence").at("message").get<std::string>(),
              HasSubstr("instead of every 200"));
}

TEST_F(ClientRole, ARequestAfterTheEndIsNotChargedToTheNextCase) {
  run({cadence_case(), read_case("none", "0000")},
      {"--endpoint", program(), "--stimulus", "-", "--profile", profile()},
      {{{"FIELDPROOF_CLIENT", "late"}}, ""});
  EXPECT_EQ(results.verdict("xgt_cnet/client/read/none"), "INCONCLUSIVE")
      << results.of("xgt_cnet/client/read/none").dump(1);
}

TEST_F(ClientRole, AProgramThatAsksTwiceFails) {
  EXPECT_EQ(run({read_case("none", "0000")},
                {"--endpoint", program(), "--stimulus", "-", "--profile", profile()},
                {{{"FIELDPROOF_CLIENT", "twice"}}, ""})
                .code,
            1);
  // 38 where the busy machine has heard the first two late.
  EXPECT_THAT(results.of("xgt_cnet/client/read/none").at("message").dump(),
              testing::ContainsRegex("(19|38) bytes came where silence is due"));
}

TEST_F(ClientRole, ADeviceThatAsksNothingIsTroubleOfTheBench) {
  const Finished finished = run(
      {read_case("none", "0000")},
      {"--endpoint", "exec:cat > /dev/null; : {tty}", "--stimulus", "-", "--profile", profile()});
  EXPECT_EQ(finished.code, 3);
  EXPECT_THAT(finished.err, HasSubstr("nothing is asked on exec:"));
  EXPECT_THAT(finished.err, HasSubstr("RUN"));
}

TEST_F(ClientRole, WithoutAnythingThatMakesItAskTheEngineerReadsWhatToSetUp) {
  EXPECT_EQ(
      run({read_case("none", "0000")}, {"--endpoint", program(), "--profile", profile()}).code, 4);
  EXPECT_THAT(results.of("xgt_cnet/client/read/none").at("message").dump(),
              HasSubstr("P2P 1 block 0: xgt-cnet client, channel 1, read, single, word, on "
                        "%MX00000, from %MW100 of station 2, into %MW200"));
}

TEST_F(ClientRole, PreparedBlocksAreArmedAndLookedAtOverASecondChannel) {
  const std::string blocks =
      R"([{"block": 0, "function": "read", "flag": "%MX00000", "read": ["%MW100"], "save": ["%MW200"], "station": 2}])";
  Process plc({"python3", script(), folder / "port", folder / "aux", blocks});
  ASSERT_TRUE(plc.wait_for("ready"));
  ordered_json good = read_case("none", "0000"), wrong = read_case("nak", "000F");
  good["steps"][3]["check"].erase("%LW513");
  wrong["steps"][3]["check"] = {{"%LW512", "0001"}};  // the client says 0002
  const std::vector<std::string> arguments{
      "--endpoint",    "serial:" + folder / "port",
      "--aux",         "serial:" + folder / "aux?station=3",
      "--profile",     profile(ordered_json::array({read_block})),
      "--allow-write", "M"};
  EXPECT_EQ(run({good, wrong, write_case()}, arguments).code, 1);
  EXPECT_EQ(results.verdict("xgt_cnet/client/read/none"), "PASS")
      << results.of("xgt_cnet/client/read/none").dump(1);
  EXPECT_EQ(results.of("xgt_cnet/client/read/nak").at("message"), "%LW512 holds 0002, 0001 is due");
  EXPECT_EQ(results.verdict("xgt_cnet/client/write"), "BLOCKED")
      << "another block than the prepared one";
  EXPECT_THAT(
      results.of("xgt_cnet/client/write").at("message").get<std::string>(),
      HasSubstr(R"(listed there is another: function is "read", "write" is needed; save is )"
                R"(["%MW200"], ["%MW300"] is needed)"));
}

/// What the bench sets over the second channel is put back there: flags and data; after a kill by
/// `restore`.
TEST_F(ClientRole, MemorySetOverTheSecondChannelIsPutBack) {
  const std::string blocks =
      R"([{"block": 0, "function": "write", "flag": "%MX00000", "read": ["%MW100"], "save": ["%MW300"], "station": 2}])";
  Process plc({"python3", script(), folder / "port", folder / "aux", blocks,
               R"({"%MW100": "0BAD", "%MW0": "8000"})"});
  ASSERT_TRUE(plc.wait_for("ready"));
  const std::string aux = "serial:" + folder / "aux?station=3",
                    journal = folder / "out/journal.ndjson";
  const ordered_json write_block{{"function", "write"},
                                 {"flag", "%MX00000"},
                                 {"read", "%MW100"},
                                 {"save", "%MW300"},
                                 {"station", 2}};
  const std::vector<std::string> arguments{
      "--endpoint",    "serial:" + folder / "port",
      "--aux",         aux,
      "--allow-write", "M",
      "--profile",     profile(ordered_json::array({write_block}))};
  const auto holds = [&](const std::string& address, const std::string& digits) {
    ordered_json look = small_vector("look", "[ACK st 'rSS' '01' '02' '" + digits + "' ETX BCC]");
    look["steps"][0]["send"] = "[ENQ st 'rSS' '01' name(" + address + ") EOT BCC]";
    return run_tool({"run", "--endpoint", aux, "--profile", "xbc-h", "--vectors",
                     write_vectors(folder, {look}), "--out", folder / "look"})
               .code == 0;
  };
  EXPECT_EQ(run({write_case()}, arguments).code, 0);
  EXPECT_TRUE(holds("%MW100", "0BAD"));
  EXPECT_TRUE(holds("%MW0", "8000"));
  EXPECT_THAT(read_text(journal), HasSubstr(R"("endpoint":"serial:)" + folder / "aux?station=3"));

  const std::string open =
      R"({"saved":{"address":"%MW100","config":{},"endpoint":")" + aux +
      R"(","model":"xbc-h","number":1,"protocol":"xgt-cnet","station":3,"value":"1BAD"}})";
  folder.write("out/journal.ndjson", open + "\n");
  EXPECT_THAT(run({write_case()}, arguments).err, HasSubstr("cannot write to " + aux));
  EXPECT_EQ(run_tool({"restore", journal}).code, 0);
  EXPECT_TRUE(holds("%MW100", "1BAD"));
}

TEST_F(ClientRole, RolesSelectCases) {
  const std::string vectors = write_vectors(folder, {small_vector("server/one"), cadence_case()});
  EXPECT_THAT(run_tool({"list", "--role", "client", "--vectors", vectors}).out,
              HasSubstr("1 cases"));
  EXPECT_THAT(run_tool({"list", "--role", "server", "--vectors", vectors}).out,
              HasSubstr("xgt_cnet/server/one"));
  const ordered_json wrong = with(cadence_case(), "steps", {{{"partner", partner("wrong_bcc")}}});
  const Finished refused = run_tool({"list", "--vectors", write_vectors(folder, {wrong})});
  EXPECT_EQ(refused.code, 2);
}

}  // namespace
}  // namespace fieldproof::tool_tests
