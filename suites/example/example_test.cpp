// The example of the page beside this file, and our own emulator: what a bench can set up, it
// judges.
#include <gmock/gmock.h>

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

TEST(ExampleDevice, WhatItDoesNotSupportIsBlockedAndSaysSo) {
  const TestFolder folder;
  const Finished finished = tool_tests::run_tool(
      {"run", "--endpoint", inverter, "--control", "-", "--profile", "inverter", "--filter",
       "ls_bus/stations/two_inverters", "--role", "server", "-v", "--out", folder.path()});
  EXPECT_THAT(finished.out, HasSubstr("needs neighbours = [2], which --control does not support"));
}

TEST(ControlOption, OfADeviceThatTheBenchHasNotStartedNeedsACommand) {
  const Finished finished =
      tool_tests::run_tool({"run", "--endpoint", "tcp:127.0.0.1:9", "--control", "-"});
  EXPECT_EQ(finished.code, 2);
  EXPECT_THAT(finished.err, HasSubstr("--control -: the bench has not started this device"));
}

/// The emulator takes the same lines: configuration, inputs, stop and counters of a PLC.
TEST(ControlOption, SetsUpAPlc) {
  const TestFolder folder;
  const Finished finished = tool_tests::run_tool(
      {"run", "--endpoint",
       "exec:" FIELDPROOF_TOOL
       " emulate 'xbc-h?protocol=modbus-ascii&station={station}' --control - --pty {tty}",
       "--control", "-", "--protocol", "modbus-ascii", "--profile", "xbc-h", "--role", "server",
       "--filter",
       // Counters at power-on are not seen: the bench asks before it looks.
       "modbus_ascii/bases/*:modbus_ascii/modes/*:modbus_ascii/station*/*:*/status*/*:"
       "-*/status/power_cycle",
       "--out", folder.path()});
  EXPECT_EQ(finished.code, 0) << finished.out << finished.err;
  tool_tests::Results results = tool_tests::read_results(folder / "results.ndjson");
  EXPECT_EQ(results.counts()["BLOCKED"], 0u) << finished.out;
  EXPECT_GT(results.counts()["PASS"], 50u);
}

}  // namespace
}  // namespace fieldproof::example
