// `fieldproof explore` by the built tool: healthy devices, broken ones, what it leaves behind.
#include <gmock/gmock.h>

#include <filesystem>

#include "suites/tool/network_runs.hpp"

namespace fieldproof::tool_tests {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class ExploreCommand : public testing::Test {
 protected:
  Finished explore(std::vector<std::string> more) {
    more.insert(more.begin(), {"explore", "--seed", "1", "--out", folder / "out"});
    const Finished finished = run_tool(more);
    if (std::filesystem::exists(folder / "out/results.ndjson"))
      results = read_results(folder / "out/results.ndjson");
    return finished;
  }
  /// The vectors that it wrote.
  std::vector<std::string> findings() const {
    std::vector<std::string> files;
    if (std::filesystem::exists(folder / "out/findings"))
      for (const auto& entry : std::filesystem::directory_iterator(folder / "out/findings"))
        files.push_back(entry.path().string());
    return files;
  }
  int verdict_of(const std::string& vectors, const std::string& endpoint) {
    return run_tool({"run", "--protocol", "xgt-cnet", "--vectors", vectors, "--endpoint", endpoint,
                     "--out", folder / "again"})
        .code;
  }
  static std::string broken(const std::string& fault) {
    return std::string("exec:") + BROKEN_SERVER + " " + fault + " {tty}";
  }

  const TestFolder folder;
  Results results;
};

TEST_F(ExploreCommand, HealthyDevicesShowNothing) {
  const Finished finished = explore({"--requests", "1000"});
  EXPECT_EQ(finished.code, 0) << finished.out << finished.err;
  EXPECT_THAT(finished.out,
              AllOf(HasSubstr("requests of xgt-cnet in "), HasSubstr("seed 1: 0 findings")));
  EXPECT_EQ(findings().size(), 0u);
  EXPECT_GT(results.counts()["PASS"], 30u);
  EXPECT_THAT(results.of("xgt_cnet/explore/rss/elsewhere")["notes"].dump(), HasSubstr("answered"));
}

TEST_F(ExploreCommand, AHealthyClientShowsNothing) {
  const Finished finished =
      explore({"--role", "client", "--requests", "500", "--protocol", "modbus-rtu"});
  EXPECT_EQ(finished.code, 0) << finished.out << finished.err;
  EXPECT_THAT(finished.out, HasSubstr("seed 1: 0 findings"));
  EXPECT_GT(results.counts()["PASS"], 15u);
  EXPECT_EQ(explore({"--role", "client", "--protocol", "udata"}).code, 4);
}

/// Red on the device that showed it, green on a healthy one.
TEST_F(ExploreCommand, AFindingIsAVector) {
  const Finished finished =
      explore({"--requests", "600", "--fail-fast", "--endpoint", broken("bytes_swapped")});
  EXPECT_EQ(finished.code, 1) << finished.out << finished.err;
  EXPECT_THAT(finished.out, AllOf(HasSubstr("shown again three times"), HasSubstr("--vectors")));
  ASSERT_EQ(findings().size(), 1u);
  EXPECT_EQ(verdict_of(findings().front(), broken("bytes_swapped")), 1);
  EXPECT_EQ(verdict_of(findings().front(), broken("none")), 0);
  EXPECT_EQ(verdict_of(findings().front(), "emulator:xbc-h"), 0);
}

/// A device's own process remembers what was before: only what does not depend on it is sent.
TEST_F(ExploreCommand, AHealthyProcessShowsNothing) {
  const Finished finished = explore({"--requests", "60", "--endpoint", broken("none")});
  EXPECT_EQ(finished.code, 0) << finished.out << finished.err;
  EXPECT_THAT(finished.out, HasSubstr("0 findings"));
}

/// `emulate` at a pty, which remembers what it was asked, as a PLC does.
class Plc {
 public:
  explicit Plc(const TestFolder& folder)
      : path_(folder / "plc"), process_(tool_arguments({"emulate", "xbc-h", "--pty", path_})) {
    EXPECT_TRUE(process_.wait_for(path_));
  }
  std::string endpoint() const { return "serial:" + path_; }

 private:
  std::string path_;
  Process process_;
};

/// What was there is there again, and nothing outside the fence was ever another.
TEST_F(ExploreCommand, StaysInsideTheFence) {
  const Plc plc(folder);
  const std::vector<std::string> real{"--endpoint", plc.endpoint(), "--profile",
                                      "xbc-h",      "--protocol",   "xgt-cnet"};
  std::vector<std::string> arguments{"--requests", "150", "--allow-write", "M100-M119", "-v"};
  arguments.insert(arguments.end(), real.begin(), real.end());
  const Finished finished = explore(arguments);
  EXPECT_EQ(finished.code, 0) << finished.out << finished.err;
  EXPECT_THAT(finished.out, HasSubstr("0 findings"));
  EXPECT_GT(results.counts()["PASS"], 5u);
  for (const auto& one : results.cases) {
    EXPECT_NE(one["verdict"], "FAIL");
    EXPECT_NE(one["verdict"], "ERROR");
  }
}

/// Whatever somebody asked it before: registered monitors are still there in the next run.
TEST_F(ExploreCommand, AHealthyDeviceShowsNothingTwice) {
  const Plc plc(folder);
  for (const char* run : {"3", "4", "5"}) {
    const Finished finished =
        run_tool({"explore", "--seed", run, "--out", folder / "out", "--requests", "150",
                  "--allow-write", "M100-M119", "--endpoint", plc.endpoint(), "--profile", "xbc-h",
                  "--protocol", "xgt-cnet"});
    EXPECT_EQ(finished.code, 0) << run << finished.out << finished.err;
    EXPECT_THAT(finished.out, HasSubstr("0 findings"));
  }
}

/// What binds any device is not excused by a profile that is advisory.
TEST_F(ExploreCommand, WrongDataIsRedOnAnAdvisoryProfile) {
  const Finished finished = explore({"--profile", "xbc-dxxxh", "--requests", "600", "--fail-fast",
                                     "--endpoint", broken("word_bytes_swapped_in_reads")});
  EXPECT_EQ(finished.code, 1) << finished.out << finished.err;
}

/// An interrupt is told once, and not as a trouble of the bench.
TEST_F(ExploreCommand, AnInterruptOnAWireReports) {
  Process process(tool_arguments({"explore", "--seed", "1", "--duration", "1h", "--endpoint",
                                  broken("none"), "--out", folder / "out"}));
  EXPECT_TRUE(process.wait_for("requests a second here"));
  process.signal(SIGINT);
  const Finished finished = process.wait();
  EXPECT_EQ(finished.code, 130) << finished.out << finished.err;
  EXPECT_THAT(finished.out, testing::Not(HasSubstr("ERROR")));
}

TEST_F(ExploreCommand, SaysWhatCannotBeExplored) {
  const Finished udata = explore({"--protocol", "udata"});
  EXPECT_EQ(udata.code, 4);
  EXPECT_THAT(udata.err, HasSubstr("udata cannot be explored: no vector has a request"));
  EXPECT_EQ(explore({"--requests", "0"}).code, 2);
  EXPECT_EQ(explore({"--duration", "soon"}).code, 2);
  EXPECT_THAT(explore({"--sed", "1"}).err, HasSubstr("did you mean '--seed'?"));
}

/// Ctrl-C reports what was found so far.
TEST_F(ExploreCommand, AnInterruptReports) {
  Process process(tool_arguments({"explore", "--seed", "1", "--duration", "1h", "--protocol",
                                  "modbus-rtu", "--out", folder / "out"}));
  EXPECT_TRUE(process.wait_for("fieldproof 0"));
  process.signal(SIGINT);
  const Finished finished = process.wait();
  EXPECT_EQ(finished.code, 130) << finished.out << finished.err;
  EXPECT_THAT(finished.out, HasSubstr("requests of modbus-rtu"));
  EXPECT_TRUE(std::filesystem::exists(folder / "out/junit.xml"));
}

/// What a bad line makes of requests: our own devices answer as they do, a device that looks at
/// half of its check is caught.
TEST(DerivedRun, HealthyDevicesPass) {
  const TestFolder folder;
  const Finished finished = run_tool({"run", "--derived", "--filter",
                                      "modbus_rtu/examples/*/derived/*:ls_bus/read/*/derived/*:"
                                      "xgt_fenet/read/*/derived/split",
                                      "--out", folder.path()});
  EXPECT_EQ(finished.code, 0) << finished.out << finished.err;
  Results results = read_results(folder / "results.ndjson");
  EXPECT_GT(results.counts()["PASS"], 50u);
  EXPECT_EQ(results.counts().size(), 1u);
}

TEST(DerivedRun, HalfACheckIsNotEnough) {
  const TestFolder folder;
  const Finished finished = run_tool(
      {"run", "--derived", "--filter", "xgt_cnet/rss/*/derived/flipped", "--max-failures", "1",
       "--endpoint", std::string("exec:") + BROKEN_SERVER + " bcc_first_digit_alone {tty}", "--out",
       folder.path()});
  EXPECT_EQ(finished.code, 1) << finished.out << finished.err;
  EXPECT_THAT(finished.out, AllOf(HasSubstr("/derived/flipped"), HasSubstr("--derived")));
}

}  // namespace
}  // namespace fieldproof::tool_tests
