#include "harness/endpoints/set_up/command_marks.hpp"

#include <gmock/gmock.h>

namespace fieldproof::endpoints {
namespace {

using nlohmann::json;
using testing::HasSubstr;

std::string filled(const std::string& command, const json& config) {
  return CommandMarks(command).filled(config);
}

TEST(CommandMarks, BecomeWhatTheConfigurationHas) {
  EXPECT_EQ(filled("plc {tty} -s {station} -d {delay_ms}", {{"station", 31}, {"delay_ms", "100"}}),
            "plc {tty} -s 31 -d 100");
  EXPECT_EQ(filled("plc {station}{station}", {{"station", 3}}), "plc 33");
}

TEST(CommandMarks, AreOneWordOfTheShell) {
  EXPECT_EQ(filled("plc {line} {host_table}", {{"host_table", {"10.0.0.1"}}}),
            "plc '' '[\"10.0.0.1\"]'");
  EXPECT_EQ(filled("plc {config}", {{"station", 1}}), "plc '{\"station\":1}'");
}

TEST(CommandMarks, TheBasesStandInTheOrderOfTheDialog) {
  EXPECT_EQ(filled("plc {bases}", {{"bit_read_base", "P0"}, {"word_read_base", "P020"}}),
            "plc P0,,P020,");
}

TEST(CommandMarks, WhatIsNoMarkStays) {
  for (const char* command : {"plc {port}", "plc ${station}", "awk '{print $1}'", "plc {}",
                              "plc {station", "x {Station}"})
    EXPECT_EQ(filled(command, {{"station", 1}, {"port", 2}}), command);
}

TEST(CommandMarks, TellWhichKeysTheyTake) {
  const CommandMarks marks("plc {station} {bases}");
  EXPECT_TRUE(marks.takes("station"));
  EXPECT_TRUE(marks.takes("word_write_base"));
  EXPECT_FALSE(marks.takes("delay_ms"));
  EXPECT_FALSE(marks.takes("bases of another kind"));
  EXPECT_TRUE(CommandMarks("plc {config}").takes("delay_ms"));
  EXPECT_FALSE(CommandMarks("plc ${station}").takes("station"));
}

TEST(CommandMarks, ASlipIsAnError) {
  EXPECT_EQ(CommandMarks::check("plc {staton}").error().message,
            "there is no mark {staton}; did you mean 'station'?");
  EXPECT_TRUE(CommandMarks::check("awk '{print}' {tty} {port} {udp_port} {whatever}"));
}

}  // namespace
}  // namespace fieldproof::endpoints
