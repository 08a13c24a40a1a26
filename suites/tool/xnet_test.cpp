// X-NET on PLCs that are seen through Modbus, by the built tool: two emulated ones in two
// processes, joined by the modelled bus.
#include <gmock/gmock.h>

#include <algorithm>
#include <memory>

#include "suites/tool/network_runs.hpp"

namespace fieldproof::tool_tests {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;

const std::string profiles = FIELDPROOF_SOURCE_DIR "/suites/profiles/";

/// PLC A with the ladder of the profile, B without one; each has its own process.
class TwoPlcs : public testing::Test {
 protected:
  void start(const json& a, const json& b) {
    folder.write("a.json", a.dump());
    folder.write("b.json", b.dump());
    const std::string bus = std::to_string(free_port());
    first = emulate("xd3?protocol=modbus-tcp", "a.json", {"--tcp", std::to_string(port)}, bus);
    second = emulate("xd3?protocol=modbus-rtu", "b.json", {"--pty", folder / "b"}, bus);
    EXPECT_TRUE(first->wait_for("bus 127.0.0.1:" + bus));
    EXPECT_TRUE(second->wait_for("bus 127.0.0.1:" + bus));
  }
  void start() {
    const json declared = json::parse(read_text(profiles + "xinje-xd.json"))["config"];
    start({{"ports", declared["ports"]}, {"program", declared["program"]}},
          {{"ports", declared["stations"][0]["ports"]}});
  }
  std::unique_ptr<Process> emulate(const std::string& model, const std::string& config,
                                   std::vector<std::string> where, const std::string& bus) {
    where.insert(where.begin(), {"emulate", model, "--config", folder / config, "--bus", bus});
    return std::make_unique<Process>(tool_arguments(where));
  }
  Finished run(const std::string& filter, const std::vector<std::string>& more) {
    std::vector<std::string> all{
        "run",   "--endpoint",  "tcp:127.0.0.1:" + std::to_string(port), "--filter", filter,
        "--out", folder / "out"};
    all.insert(all.end(), more.begin(), more.end());
    const Finished finished = run_tool(all);
    results = read_results(folder / "out/results.ndjson");
    return finished;
  }
  std::string message(const std::string& id) const { return results.of(id).value("message", ""); }

  const std::uint16_t port = free_port();
  const TestFolder folder;
  std::unique_ptr<Process> first, second;
  Results results;
};

TEST_F(TwoPlcs, InstructionsAreSeenByTheirEffects) {
  start();
  const Finished finished =
      run("xnet/instruction_data/*", {"--aux", "serial:" + (folder / "b"), "--profile", "xinje-xd",
                                      "--allow-write", "D,M,SD,HD,HM,Y"});
  EXPECT_EQ(finished.code, 0) << finished.out << finished.err;
  EXPECT_EQ(results.verdict("xnet/instruction_data/read_d0_to_d0"), "PASS");
  EXPECT_GE(results.counts()["PASS"], 50u) << finished.out;
  EXPECT_EQ(results.counts()["FAIL"], 0u);
  EXPECT_THAT(message("xnet/instruction_data/bit_read_to/c5"),
              HasSubstr("in the program of the PLC"));
}

/// B answers nobody on the bus: what does not arrive turns the run red.
TEST_F(TwoPlcs, WhatDoesNotArriveFails) {
  start();
  second->signal(SIGTERM);
  second->wait();
  second = emulate("xd3?protocol=modbus-rtu", "b.json", {"--pty", folder / "b"},
                   std::to_string(free_port()));
  EXPECT_TRUE(second->wait_for("bus "));
  EXPECT_EQ(
      run("xnet/instruction_data/read_d0_to_d0",
          {"--aux", "serial:" + (folder / "b"), "--profile", "xinje-xd", "--allow-write", "D,M,SD"})
          .code,
      1);
  EXPECT_EQ(results.verdict("xnet/instruction_data/read_d0_to_d0"), "FAIL");
}

/// What an instruction writes, in either PLC, is allowed by name, and put back.
TEST_F(TwoPlcs, WhatAnInstructionWritesIsPutBack) {
  start();
  const std::string id = "xnet/instruction_data/read_d0_to_d0";
  run(id, {"--aux", "serial:" + (folder / "b"), "--profile", "xinje-xd", "--allow-write",
           "D6000-D6999,M,SD"});
  EXPECT_THAT(message(id), HasSubstr("--allow-write D0"));
  EXPECT_EQ(run(id, {"--aux", "serial:" + (folder / "b"), "--profile", "xinje-xd", "--allow-write",
                     "D,M,SD"})
                .code,
            0);
  const std::string journal = read_text(folder / "out/journal.ndjson");
  EXPECT_THAT(journal, testing::Not(HasSubstr("\"save\""))) << "nothing is open";
}

TEST_F(TwoPlcs, WithoutASecondPortItSaysWhatIsMissing) {
  start();
  run("xnet/instruction_data/read_d0_to_d0", {"--profile", "xinje-xd", "--allow-write", "D,M,SD"});
  EXPECT_THAT(message("xnet/instruction_data/read_d0_to_d0"),
              AllOf(HasSubstr("of B"), HasSubstr("--aux")));
  run("xnet/instruction_data/read_d0_to_d0",
      {"--profile", "xinje-xd", "--aux", "serial:" + (folder / "b")});
  EXPECT_THAT(message("xnet/instruction_data/read_d0_to_d0"), HasSubstr("--allow-write"));
}

TEST_F(TwoPlcs, StationsThatClashDoNotJoin) {
  const json same{{"ports", {{{"net", 1}, {"station", 1}}}}};
  folder.write("a.json", same.dump());
  const std::string bus = std::to_string(free_port());
  first = emulate("xd3?protocol=modbus-rtu", "a.json", {"--pty", folder / "a"}, bus);
  EXPECT_TRUE(first->wait_for("bus "));
  second = emulate("xd3?protocol=modbus-rtu", "a.json", {"--pty", folder / "b"}, bus);
  const Finished finished = second->wait();
  EXPECT_EQ(finished.code, 3);
  EXPECT_THAT(finished.err, HasSubstr("station 1"));
}

/// An axis moves where it is named, and nowhere else. The PLC is a process that the bench starts
/// again where a case needs its axis at 0.
class MovingPlc : public testing::Test {
 protected:
  Finished run(const std::vector<std::string>& more) {
    const json declared = json::parse(read_text(profiles + "xinje-xdc.json"))["config"];
    const std::string config = folder.write("c.json", declared.dump());
    std::vector<std::string> all{"run",
                                 "--endpoint",
                                 "exec:" + quoted(FIELDPROOF_TOOL) +
                                     " emulate 'xdc?protocol=modbus-tcp' --config " + config +
                                     " --tcp {port}",
                                 "--profile",
                                 "xinje-xdc",
                                 "--filter",
                                 "xnet/*mot*",
                                 "--out",
                                 folder / "out"};
    all.insert(all.end(), more.begin(), more.end());
    const Finished finished = run_tool(all);
    if (finished.code < 2 || finished.code == 4)
      results = read_results(folder / "out/results.ndjson");
    return finished;
  }
  const TestFolder folder;
  Results results;
};

TEST_F(MovingPlc, NothingMovesThatIsNotNamed) {
  EXPECT_EQ(run({}).code, 4);
  const auto refused = [](const json& one) {
    const std::string text = one.value("message", "");
    return text.starts_with("moves axis 1 (MOTO") &&
           text.find("--allow-motion 1") != std::string::npos;
  };
  EXPECT_GT(std::ranges::count_if(results.cases, refused), 20);
  EXPECT_EQ(run({"--allow-motion", "2"}).code, 4);
  const Finished wrong = run({"--allow-motion", "one"});
  EXPECT_EQ(wrong.code, 2);
  EXPECT_THAT(wrong.err, HasSubstr("--allow-motion 'one': write an axis (1)"));
}

TEST_F(MovingPlc, WhatIsNamedMovesFromWhereTheCaseBegins) {
  const Finished finished = run({"--allow-motion", "1"});
  EXPECT_EQ(finished.code, 0) << finished.out;
  EXPECT_GE(results.counts()["PASS"], 4u) << finished.out;
  EXPECT_EQ(results.counts()["FAIL"], 0u);
}

}  // namespace
}  // namespace fieldproof::tool_tests
