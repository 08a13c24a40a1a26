// What a run says where nothing, or nothing right, answers: the bench makes the diagnosis that the
// probe makes, before a case is judged.
#include <gmock/gmock.h>

#include <memory>

#include "suites/tool/joined_ptys.hpp"
#include "suites/tool/tool_files.hpp"

namespace fieldproof::tool_tests {
namespace {

using testing::AllOf;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;

constexpr const char* testdata = FIELDPROOF_SOURCE_DIR "/suites/tool/testdata/";

std::string device(const std::string& behaviour, const std::string& arguments = "") {
  return "exec:/usr/bin/python3 " + std::string(testdata) + "device.py " + behaviour + " {tty}" +
         arguments;
}

/// The emulator as a program, over a line that echoes.
std::string echoing(const std::string& emulated) {
  return "exec:/usr/bin/python3 " + std::string(testdata) + "echoing_line.py {tty} \"" +
         FIELDPROOF_TOOL + " emulate '" + emulated + "' --pty {device}\"";
}

std::string emulated(const std::string& name) {
  return "exec:" FIELDPROOF_TOOL " emulate '" + name + "' --pty {tty}";
}

class Diagnosis : public testing::Test {
 protected:
  Finished run(const std::string& endpoint, const std::vector<std::string>& more = {},
               const std::string& profile = "xbc-h") {
    std::vector<std::string> arguments{"run",   "--endpoint", endpoint, "--profile",
                                       profile, "--out",      out_};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_tool(arguments);
  }
  std::vector<std::string> few() { return {"--vectors", write_vectors(folder_, many_vectors(3))}; }
  Results results() const { return read_results(out_ + "/results.ndjson"); }
  std::string profile_at_station(int station) {
    return folder_.write("own.json",
                         R"({"extends": "xbc-h", "name": "own", "config": {"station": )" +
                             std::to_string(station) + "}}");
  }

  TestFolder folder_;
  std::string out_ = folder_ / "out";
};

// ---- echo

TEST_F(Diagnosis, EchoIsTroubleOfTheBenchAndNoCaseIsJudged) {
  const JoinedPtys line;
  Process behind({"/usr/bin/python3", std::string(testdata) + "device.py", "echo", line.device()});
  for (const std::string& endpoint :
       {device("echo"), std::string("exec:sh -c 'exec cat <{tty} >{tty}'"),
        "serial:" + line.bench()}) {
    const Finished finished = run(endpoint, few());
    EXPECT_EQ(finished.code, 3) << endpoint << finished.out;
    EXPECT_THAT(finished.err, AllOf(HasSubstr("the bench hears its own requests: echo on"),
                                    HasSubstr("without echo (rs485=1, or rs485=rts)"),
                                    HasSubstr("echo=on behind the '?'")));
    EXPECT_TRUE(results().cases.empty());
    EXPECT_TRUE(results().run["properties"].value("floor", "").empty()) << "measured on echoes";
    expect_reports(out_);
  }
}

TEST_F(Diagnosis, EchoIsTakenOutOnRequest) {
  EXPECT_EQ(run(device("echo", "?echo=on"), few()).code, 0);
  EXPECT_EQ(results().counts(), (std::map<std::string, std::size_t>{{"PASS", 3}}));
}

/// Where a reply has the bytes of its request, one of the two is the echo, and one is the reply.
TEST_F(Diagnosis, BehindAnEchoEachCaseHasTheVerdictThatItHasWithoutOne) {
  const std::vector<std::string> cases{"--filter", "modbus_rtu/examples/*"};
  std::map<std::string, nlohmann::json> verdicts[2];
  const std::string endpoints[] = {emulated("xbc-h?protocol=modbus-rtu"),
                                   echoing("xbc-h?protocol=modbus-rtu") + "?echo=on"};
  for (std::size_t i = 0; i < 2; ++i) {
    const Finished finished = run(endpoints[i], cases);
    EXPECT_EQ(finished.code, 0) << finished.out << finished.err;
    for (const nlohmann::json& one : results().cases) verdicts[i][one.at("id")] = one.at("verdict");
  }
  EXPECT_EQ(verdicts[0], verdicts[1]);
  EXPECT_GT(verdicts[1].size(), 10u);
}

TEST_F(Diagnosis, AnEchoThatDoesNotComeIsSaid) {
  const Finished finished = run(device("good", "?echo=on"), few());
  EXPECT_EQ(finished.code, 3);
  EXPECT_THAT(finished.err, AllOf(HasSubstr("with echo=on: of 3 requests none has come back"),
                                  HasSubstr("leave echo=on out")));
  EXPECT_TRUE(results().cases.empty());
}

TEST_F(Diagnosis, ADamagedEchoIsReceivedAndSaid) {
  for (const char* behaviour : {"echo_bad", "echo_lost"}) {
    // One answer to the first probe, twenty for the floor.
    const Finished finished = run(device(behaviour, " 21?echo=on"), few());
    EXPECT_EQ(finished.code, 1) << finished.err;
    EXPECT_THAT(finished.out, ContainsRegex("missing or damaged echo(es)? \\(of 05 30 31"));
    EXPECT_EQ(results().counts(), (std::map<std::string, std::size_t>{{"FAIL", 3}})) << behaviour;
  }
}

TEST_F(Diagnosis, EchoIsNoMatterOfNetworks) {
  const Finished finished = run("tcp:127.0.0.1:502?protocol=modbus-tcp&echo=on",
                                {"--filter", "modbus_tcp/examples/*", "--role", "server"});
  EXPECT_EQ(finished.code, 2);
  EXPECT_THAT(finished.err, HasSubstr("it runs on a network, where nothing echoes"));
}

// ---- looking on

TEST_F(Diagnosis, AStationWrittenInHexIsFound) {
  const Finished finished = run(emulated("xbc-h?station=32") + "?station=20", few());
  EXPECT_EQ(finished.code, 3);
  EXPECT_THAT(finished.err, AllOf(HasSubstr("at station 20 by xgt-cnet; but xgt-cnet, station 32,"),
                                  HasSubstr("write station=32 behind the '?' of the endpoint"),
                                  HasSubstr("\"config\": {\"station\": 32} in the profile"),
                                  HasSubstr("32 is 20 hex")));
  EXPECT_TRUE(results().cases.empty());
  expect_reports(out_);
}

TEST_F(Diagnosis, AnotherStationOfAnotherProtocolIsFound) {
  const JoinedPtys line("xbc-h?station=3&protocol=modbus-rtu");
  const Finished finished = run("serial:" + line.bench(), few());
  EXPECT_EQ(finished.code, 3);
  EXPECT_THAT(finished.err,
              AllOf(HasSubstr("but modbus-rtu, station 3, answers in"),
                    HasSubstr("write protocol=modbus-rtu&station=3 behind the '?' of the endpoint "
                              "(or --protocol modbus-rtu)")));
}

TEST_F(Diagnosis, WithoutAFindItSaysWhatWasTried) {
  const JoinedPtys line("xbc-h?station=77");
  const Finished finished = run("serial:" + line.bench(), few());
  EXPECT_EQ(finished.code, 3);
  EXPECT_THAT(finished.err,
              AllOf(HasSubstr("nothing answers on serial:"), HasSubstr("check that the device"),
                    HasSubstr("nor does anything else there: asked modbus-rtu at stations 0 to 3"),
                    ContainsRegex("xgt-cnet at stations 0, 2 to [123]")));
}

// ---- the profile's station

TEST_F(Diagnosis, TheProfilesStationIsAsked) {
  const std::string profile = profile_at_station(9);
  EXPECT_EQ(run(emulated("xbc-h?station=9"), few(), profile).code, 0);
  EXPECT_EQ(results().run["properties"]["station"], "9");
  EXPECT_EQ(run(emulated("xbc-h?station=5") + "?station=5", few(), profile).code, 0)
      << "what the endpoint says goes before";
  EXPECT_EQ(results().run["properties"]["station"], "5");
  const Finished wrong = run("emulator:xbc-h", few(), profile_at_station(900));
  EXPECT_EQ(wrong.code, 2);
  EXPECT_THAT(wrong.err, HasSubstr("cannot use profile own: config.station 900 is not a number"));
}

// ---- the fingerprint of a port

TEST_F(Diagnosis, TheProbeTakesTheFingerprintOfAPortThatItHasSearched) {
  const JoinedPtys line("xbc-h?station=3");
  const Finished probe =
      run_tool({"probe", "serial:" + line.bench(), "--station", "3", "--fingerprint"});
  EXPECT_EQ(probe.code, 0) << probe.err;
  EXPECT_THAT(probe.err, Not(HasSubstr("in use")));
  EXPECT_THAT(probe.out, AllOf(HasSubstr("fingerprint "), HasSubstr("\"areas\"")));
}

}  // namespace
}  // namespace fieldproof::tool_tests
