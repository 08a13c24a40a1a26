// The example of the page beside this file, and our own emulator: what a bench can set up, it
// judges.
#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "suites/tool/tool_files.hpp"

namespace fieldproof::example {
namespace {

using testing::HasSubstr;
using testing::Not;
using tool_tests::Finished;
using tool_tests::TestFolder;

const std::string inverter = "exec:python3 -B " FIELDPROOF_SOURCE_DIR
                             "/suites/example/inverter.py {tty} {station} {write_order}";

TEST(ExampleDevice, IsJudgedInNearlyAllOfItsModel) {
  const TestFolder folder;
  const Finished finished = tool_tests::run_tool(
      {"run", "--endpoint", inverter, "--control", "-", "--profile", "inverter", "--role", "server",
       "--filter", "ls_bus/*", "--min-judged", "97%", "--out", folder.path()});
  EXPECT_EQ(finished.code, 0) << finished.out << finished.err;
  EXPECT_THAT(finished.out, Not(HasSubstr("FAIL")));
  tool_tests::Results results = tool_tests::read_results(folder / "results.ndjson");
  EXPECT_GT(results.counts()["PASS"], 290u);
  EXPECT_EQ(results.counts()["SKIP"], 0u);
  EXPECT_EQ(results.counts()["BLOCKED"], 0u) << "what is left needs a wire";
}

/// Without the marks these cases are BLOCKED.
TEST(ExampleDevice, IsGivenStationAndWriteOrder) {
  const TestFolder folder;
  const Finished finished =
      tool_tests::run_tool({"run", "--endpoint", inverter, "--profile", "inverter", "--filter",
                            "ls_bus/write_order/count/*:ls_bus/stations/station_*", "--role",
                            "server", "--out", folder.path()});
  EXPECT_EQ(finished.code, 0) << finished.out << finished.err;
  tool_tests::Results results = tool_tests::read_results(folder / "results.ndjson");
  EXPECT_EQ(results.counts()["BLOCKED"], 0u) << finished.out;
  EXPECT_EQ(results.counts()["PASS"], 17u);
}

/// The inverter behind a script that writes down what it is started with.
class CountedStarts : public testing::Test {
 protected:
  CountedStarts() {
    const std::string script = folder_.write("counted",
                                             "#!/bin/sh\nport=$1\nshift\necho \"$*\" >>starts\n"
                                             "exec python3 -B " FIELDPROOF_SOURCE_DIR
                                             "/suites/example/inverter.py $port \"$@\"\n");
    std::filesystem::permissions(script, std::filesystem::perms::owner_all);
  }

  /// Runs the tool in the folder; what the device was started with, in order.
  std::vector<std::string> starts(const std::vector<std::string>& arguments) {
    finished_ = tool_tests::run_tool(arguments, {.environment = {}, .folder = folder_.path()});
    return tool_tests::text_lines(tool_tests::read_text(folder_ / "starts"));
  }

  const std::string counted_ = "exec:./counted {tty} {station} {write_order} {delay_ms}";
  TestFolder folder_;
  Finished finished_;
};

/// Cases are grouped over the whole run: a command line that another one has followed does not come
/// again. What is switched off by a case is started with the same once more.
TEST_F(CountedStarts, AreAsManyAsCommandLinesAndPowerCycles) {
  const std::vector<std::string> all =
      starts({"run", "--endpoint", "exec:./counted {tty} {station} {write_order}", "--control", "-",
              "--profile", "inverter", "--role", "server", "--filter", "ls_bus/*", "--out",
              folder_ / "out"});
  EXPECT_EQ(finished_.code, 0) << finished_.out << finished_.err;
  const std::set<std::string> different(all.begin(), all.end());
  EXPECT_GE(different.size(), 11u);
  std::vector<std::string> groups = all;
  groups.erase(std::unique(groups.begin(), groups.end()), groups.end());
  EXPECT_EQ(groups.size(), different.size());
  constexpr std::size_t power_cycles = 2;  // ls_bus/frame_structure/power_cycle_*
  EXPECT_EQ(all.size(), different.size() + power_cycles);
}

TEST_F(CountedStarts, HaveEveryMarkFilledFromTheFirst) {
  EXPECT_THAT(starts({"run", "--endpoint", counted_, "--profile", "inverter", "--filter",
                      "ls_bus/read/example", "--role", "server", "--out", folder_ / "out"}),
              testing::ElementsAre("1 address_first 0"));
  EXPECT_EQ(finished_.code, 0) << finished_.out << finished_.err;
}

/// `init` asks it before anybody has said which profile it is of.
TEST_F(CountedStarts, OfInitHaveEveryMarkFilledFromTheFirst) {
  const std::vector<std::string> all =
      starts({"init", "--yes", "--endpoint", counted_, "--protocol", "ls-bus", "--no-run"});
  EXPECT_EQ(finished_.code, 0) << finished_.out << finished_.err;
  EXPECT_THAT(all, testing::ElementsAre("1 address_first 0"));
}

TEST(ControlOption, WhatItDoesNotSupportIsBlockedAndSaysSo) {
  const TestFolder folder;
  const Finished finished =
      tool_tests::run_tool({"run", "--endpoint", inverter, "--control",
                            "while read -r wish; do echo '{\"unsupported\": true}'; done",
                            "--profile", "inverter", "--filter", "ls_bus/stations/two_inverters",
                            "--role", "server", "-v", "--out", folder.path()});
  EXPECT_THAT(finished.out, HasSubstr("needs neighbours = [2], which --control does not support"));
}

TEST(ControlOption, OfADeviceThatTheBenchHasNotStartedNeedsACommand) {
  const Finished finished =
      tool_tests::run_tool({"run", "--endpoint", "tcp:127.0.0.1:9", "--control", "-"});
  EXPECT_EQ(finished.code, 2);
  EXPECT_THAT(finished.err, HasSubstr("--control -: the bench has not started this device"));
}

/// The emulator takes the same lines. A run that leaves no case out; `port` and what stands before
/// it are options of `emulate`.
tool_tests::Results run_of_a_plc(const std::string& protocol, const std::string& option,
                                 const std::string& port, const std::string& filter) {
  const TestFolder folder;
  const Finished finished =
      tool_tests::run_tool({"run", "--endpoint",
                            "exec:" FIELDPROOF_TOOL " emulate 'xbc-h?protocol=" + protocol +
                                option + "' --control - " + port,
                            "--control", "-", "--protocol", protocol, "--profile", "xbc-h",
                            "--role", "server", "--filter", filter, "--out", folder.path()});
  EXPECT_EQ(finished.code, 0) << finished.out << finished.err;
  tool_tests::Results results = tool_tests::read_results(folder / "results.ndjson");
  EXPECT_EQ(results.counts()["BLOCKED"], 0u) << finished.out;
  return results;
}

/// Configuration, inputs, stop and counters of a PLC.
TEST(ControlOption, SetsUpAPlc) {
  tool_tests::Results results =
      run_of_a_plc("modbus-ascii", "&station={station}", "--pty {tty}",
                   "modbus_ascii/bases/*:modbus_ascii/modes/*:modbus_ascii/station*/*:*/status*/*");
  EXPECT_GT(results.counts()["PASS"], 50u);
}

/// Past the wire: who is shut out cannot ask, and what is asked would be counted.
TEST(ControlOption, JudgesWhatCountsFromPowerOnAndAHostTableThatShutsTheBenchOut) {
  const tool_tests::Results results =
      run_of_a_plc("xgt-fenet", "", "--tcp {port} --udp {udp_port}",
                   "xgt_fenet/host_table/*:xgt_fenet/status/*:-*/not_listed_udp/*");
  EXPECT_EQ(results.verdict("xgt_fenet/status/power_cycle"), "PASS");
  EXPECT_EQ(results.verdict("xgt_fenet/host_table/empty"), "PASS");
}

/// A frame monitor that has seen nothing yet, and a station behind another one's answer.
TEST(ControlOption, JudgesAFrameMonitorAndNeighbours) {
  tool_tests::Results results =
      run_of_a_plc("modbus-rtu", "", "--pty {tty}",
                   "modbus_rtu/frame_monitor/*:modbus_rtu/station/several*:modbus_rtu/status/*");
  EXPECT_GT(results.counts()["PASS"], 5u);
}

}  // namespace
}  // namespace fieldproof::example
