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
  EXPECT_GE(results.counts()["PASS"], 60u) << finished.out;
  EXPECT_EQ(results.counts()["FAIL"], 0u);
  EXPECT_THAT(message("xnet/instruction_data/bit_write_from/x7"),
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

json vector_of(const std::string& name, const std::string& model, const json& given,
               const json& steps) {
  return {{"id", "xnet/own/" + name},
          {"title", "a vector of the tests of the tool"},
          {"kind", "instruction"},
          {"statement", "m/1"},
          {"source", {{"manual", "m"}, {"section", "1"}, {"quote", "executes an instruction"}}},
          {"level", "must"},
          {"basis", "printed rule"},
          {"models", {model}},
          {"given", given},
          {"steps", steps}};
}

/// Two XDE on one Ethernet: what A's instructions write in B is fenced as what they write in A.
class TwoOnEthernet : public testing::Test {
 protected:
  void SetUp() override {
    folder.write("a.json", with_program({{"ip", "192.168.6.6"}}).dump());
    folder.write("b.json", json{{"ip", "192.168.6.11"}}.dump());
    const std::string bus = std::to_string(free_port());
    for (const auto& [file, port] : {std::pair("a.json", a), std::pair("b.json", b)}) {
      plcs.push_back(std::make_unique<Process>(
          tool_arguments({"emulate", "xde?protocol=modbus-tcp", "--config", folder / file, "--tcp",
                          std::to_string(port), "--bus", bus})));
      EXPECT_TRUE(plcs.back()->wait_for("bus 127.0.0.1:" + bus));
    }
    json profile{
        {"name", "two"},
        {"extends", "emulator"},
        {"title", "Two XDE on Ethernet"},
        {"model", "xde"},
        {"protocols", {"xnet"}},
        {"config", with_program({{"ip", "192.168.6.6"},
                                 {"stations", {{{"model", "xde"}, {"ip", "192.168.6.11"}}}}})}};
    folder.write("profiles/two.json", profile.dump());
    json vectors = json::array();
    for (const auto& [name, text] : program.items())
      vectors.push_back(
          vector_of(name, "xde", {{"config", profile["config"]}},
                    {{{"do", text}}, {{"wait", "50ms"}}, {{"check", {{"D0", "0000"}}}}}));
    folder.write("vectors/xnet/own.json", vectors.dump());
  }
  json with_program(json config) const {
    int relay = 100;
    for (const auto& [name, text] : program.items())
      config["program"]["M" + std::to_string(relay++)] = text;
    return config;
  }
  Results run(const std::vector<std::string>& more) {
    std::vector<std::string> all{"run",
                                 "--endpoint",
                                 "tcp:127.0.0.1:" + std::to_string(a),
                                 "--aux",
                                 "tcp:127.0.0.1:" + std::to_string(b),
                                 "--profile",
                                 folder / "profiles/two.json",
                                 "--vectors",
                                 folder / "vectors",
                                 "--out",
                                 folder / "out"};
    all.insert(all.end(), more.begin(), more.end());
    const Finished finished = run_tool(all);
    EXPECT_NE(finished.code, 2) << finished.err;
    return read_results(folder / "out/results.ndjson");
  }
  const json program{{"axis", "BIT_WRITE net 49320 station 1547 SM2010 count 1 from M0"},
                     {"target", "REG_WRITE net 49320 station 1547 SD2030 count 2 from D0"},
                     {"output", "BIT_WRITE net 49320 station 1547 Y0 count 1 from M0"},
                     {"stranger", "BIT_WRITE net 49320 station 1548 M0 count 1 from M0"},
                     {"memory", "REG_WRITE net 49320 station 1547 D8 count 1 from D0"}};
  const std::uint16_t a = free_port(), b = free_port();
  const TestFolder folder;
  std::vector<std::unique_ptr<Process>> plcs;
};

TEST_F(TwoOnEthernet, WhatTheOtherPlcWouldDoIsFenced) {
  const Results refused = run({"--allow-write", "D,M,SM,SD"});
  const auto why = [](const Results& results, const std::string& name) {
    return results.of("xnet/own/" + name).value("message", "");
  };
  for (const char* name : {"axis", "target"})
    EXPECT_THAT(why(refused, name),
                AllOf(HasSubstr("moves axis B:1"), HasSubstr("--allow-motion B:1")));
  EXPECT_THAT(why(refused, "output"), HasSubstr("--allow-write Y0"));
  EXPECT_THAT(why(refused, "stranger"), HasSubstr("station 1548 of net 49320"));
  EXPECT_EQ(refused.verdict("xnet/own/memory"), "PASS") << why(refused, "memory");
  const Results own = run({"--allow-write", "D,M,SM,SD", "--allow-motion", "1"});
  EXPECT_THAT(why(own, "axis"), HasSubstr("moves axis B:1")) << "axis 1 of A is another one";
}

/// A real XINJE PLC by its Modbus server alone.
class ByModbus : public testing::Test {
 protected:
  ByModbus() : server(tool_arguments({"emulate", "xd?protocol=modbus-tcp", "--tcp", port})) {
    EXPECT_TRUE(server.wait_for("tcp 127.0.0.1:" + port));
  }
  Finished tool(const std::string& command, const std::vector<std::string>& more) {
    std::vector<std::string> all{
        command, "--endpoint",  "tcp:127.0.0.1:" + port + "?protocol=modbus-tcp", "--profile", "xd",
        "--out", folder / "out"};
    all.insert(all.end(), more.begin(), more.end());
    return run_tool(all);
  }
  const TestFolder folder;
  const std::string port = std::to_string(free_port());
  Process server;
};

TEST_F(ByModbus, ItsObjectsAreWrittenWhereTheyAreAllowed) {
  const Finished finished =
      tool("run", {"--filter", "modbus_tcp/xinje/*", "--allow-write", "all,Y"});
  EXPECT_EQ(finished.code, 0) << finished.out << finished.err;
  const Results all = read_results(folder / "out/results.ndjson");
  EXPECT_GE(all.counts().at("PASS"), 20u) << finished.out;
  EXPECT_EQ(all.counts().count("FAIL"), 0u);
  tool("run", {"--filter", "modbus_tcp/xinje/*", "--allow-write", "all"});
  const Results fenced = read_results(folder / "out/results.ndjson");
  EXPECT_THAT(fenced.of("modbus_tcp/xinje/hmi_coils").value("message", ""),
              HasSubstr("--allow-write Y0"));
}

/// What is invented is fenced, too.
TEST_F(ByModbus, NothingIsExploredThatMoves) {
  const Finished finished =
      tool("explore", {"--seed", "1", "--requests", "200", "--allow-write", "all"});
  EXPECT_NE(finished.code, 2) << finished.err;
}

/// A file that no device could run is an invalid one.
TEST(XnetVectors, WhatNoPlcHasIsRefused) {
  const TestFolder folder;
  const auto vectors = [&](const json& step) {
    folder.write(
        "vectors/xnet/own.json",
        json::array({vector_of("one", "xdc", json::object(), json::array({step}))}).dump());
    return folder / "vectors";
  };
  for (const auto& [step, says] :
       {std::pair(json{{"check", {{"ZZ0", "0000"}}}}, "ZZ0"),
        std::pair(json{{"check", {{"D70000", "0000"}}}}, "D70000"),
        std::pair(json{{"set", {{"X18", "01"}}}}, "write D100, HD0, M10 or, in octal, X17"),
        std::pair(json{{"do", "MOTO 1 2 3 axis 21"}}, "axes are 1 to 20"),
        std::pair(json{{"do", "REG_READ net 1 station 2 ZZ0 count 1 to D0"}},
                  "there is no object 'ZZ0'")}) {
    const std::string file = vectors(step);
    const Finished run = run_tool({"run", "--vectors", file, "--out", folder / "out"});
    EXPECT_EQ(run.code, 2) << step;
    EXPECT_THAT(run.err, AllOf(HasSubstr("xnet/own.json"), HasSubstr(says)));
    EXPECT_NE(run_tool({"lint", "--vectors", file}).code, 0) << step;
  }
}

/// An axis moves where it is named, and nowhere else. The PLC is a process that the bench starts
/// again where a case needs its axis at 0.
class MovingPlc : public testing::Test {
 protected:
  json declared() const { return json::parse(read_text(profiles + "xinje-xdc.json")); }

  /// A PLC with this configuration.
  Finished run(const std::string& filter, const std::vector<std::string>& more, const json& config,
               const std::string& profile = "xinje-xdc") {
    const std::string file = folder.write("c.json", config.dump());
    std::vector<std::string> all{"run",
                                 "--endpoint",
                                 "exec:" + quoted(FIELDPROOF_TOOL) +
                                     " emulate 'xdc?protocol=modbus-tcp' --config " + file +
                                     " --tcp {port}",
                                 "--profile",
                                 profile,
                                 "--filter",
                                 filter,
                                 "--out",
                                 folder / "out"};
    all.insert(all.end(), more.begin(), more.end());
    const Finished finished = run_tool(all);
    if (finished.code < 2 || finished.code == 4)
      results = read_results(folder / "out/results.ndjson");
    return finished;
  }
  Finished run(const std::string& filter, const std::vector<std::string>& more) {
    return run(filter, more, declared()["config"]);
  }
  std::ptrdiff_t told(const std::string& verdict, const std::string& beginning) const {
    return std::ranges::count_if(results.cases, [&](const json& one) {
      return one.value("verdict", "") == verdict && one.value("message", "").starts_with(beginning);
    });
  }

  const TestFolder folder;
  Results results;
};

constexpr const char* at_rest = "what is seen at rest is right; not judged: ";

TEST_F(MovingPlc, NothingMovesThatIsNotNamed) {
  const std::string moving = "xnet/*mot*";
  EXPECT_EQ(run(moving, {}).code, 4);
  const auto refused = [](const json& one) {
    const std::string text = one.value("message", "");
    return text.starts_with("moves axis 1 (MOTO") &&
           text.find("--allow-motion 1") != std::string::npos;
  };
  EXPECT_GT(std::ranges::count_if(results.cases, refused), 20);
  EXPECT_EQ(run("xnet/instruction_moto/*", {"--allow-motion", "2"}).code, 4);
  const Finished wrong = run(moving, {"--allow-motion", "one"});
  EXPECT_EQ(wrong.code, 2);
  EXPECT_THAT(wrong.err, HasSubstr("--allow-motion 'one': write an axis (1)"));
  EXPECT_THAT(run(moving, {"--allow-motion", "21"}).err, HasSubstr("axes are 1 to 20"));
}

/// Where it comes to rest is judged; what is seen on the way is not, and so no case passes of which
/// that is a part.
TEST_F(MovingPlc, WhatIsNamedMovesFromWhereTheCaseBegins) {
  const Finished finished =
      run("xnet/instruction_motoa/edge:xnet/instruction_motoa/s*:xnet/register_motion_target/"
          "absolute",
          {"--allow-motion", "1"});
  EXPECT_EQ(finished.code, 0) << finished.out;
  EXPECT_EQ(results.counts()["FAIL"] + results.counts()["NON-STRICT"], 0u);
  EXPECT_GE(results.counts()["PASS"], 1u) << finished.out;
  EXPECT_GE(told("INCONCLUSIVE", at_rest), 1) << finished.out;
}

/// MOTOA runs by the number of pulses that it should run to.
TEST_F(MovingPlc, OneThatComesToRestElsewhereFails) {
  json profile = declared();
  profile["decisions"] = {"xnet/word-order", "xnet/refresh", "xnet/feedback", "xnet/slopes"};
  json config = profile["config"];
  ASSERT_EQ(config["program"]["M6003"], "MOTOA D6910 D6912 D6914 axis 1");
  config["program"]["M6003"] = "MOTO D6910 D6912 D6914 axis 1";
  const Finished finished = run("xnet/instruction_motoa/sign", {"--allow-motion", "1"}, config,
                                folder.write("p.json", profile.dump()));
  EXPECT_EQ(finished.code, 1) << finished.out;
  EXPECT_EQ(told("FAIL", "SD2008 holds 0, -300 is due"), 1) << finished.out;
}

}  // namespace
}  // namespace fieldproof::tool_tests
