#include "reports/history/device.hpp"

#include <gmock/gmock.h>

namespace fieldproof::history {
namespace {

using testing::Optional;

results::Identity named(const std::string& name, const std::string& model = "",
                        const std::string& serial = "") {
  results::Identity identity;
  identity.name = name;
  identity.maker = model.empty() ? "" : "LS";
  identity.model = model;
  identity.serial = serial;
  return identity;
}

results::RunInfo run_with(const results::Identity& identity) {
  results::RunInfo run;
  run.endpoint = "exec:./my_plc {tty}";
  run.profile = "xbc-h";
  run.identity = identity;
  return run;
}

TEST(Device, IsKnownByTheBestThatTheRunSays) {
  results::Identity identity = named("c41a", "XBL-C41A", "7");
  EXPECT_EQ(device_of(run_with(identity)), "LS XBL-C41A, serial number 7");
  identity.firmware = "V1.41";
  EXPECT_EQ(device_of(run_with(identity)), "LS XBL-C41A, serial number 7") << "another firmware";
  identity.serial.clear();
  EXPECT_EQ(device_of(run_with(identity)), "c41a (LS XBL-C41A)");
  EXPECT_EQ(device_of(run_with(named("c41a"))), "c41a");
  EXPECT_EQ(device_of(run_with(named("", "", "7"))), "serial number 7");
  EXPECT_EQ(device_of(run_with({})), "exec:./my_plc {tty}, profile xbc-h");
}

TEST(Device, OfASharedRunIsAllOfThemInAnyOrder) {
  results::RunInfo run = run_with({}), other = run;
  run.duts = {{"serial:A", {}, named("a")}, {"serial:B", {}, named("b")}};
  other.duts = {run.duts[1], run.duts[0]};
  EXPECT_EQ(device_of(run), "a + b");
  EXPECT_EQ(device_of(other), device_of(run));
}

TEST(Device, TimesCompareAcrossZones) {
  EXPECT_THAT(seconds_of("1970-01-02T00:00:00+00:00"), Optional(86'400));
  EXPECT_THAT(seconds_of("1970-01-02T09:30:00+09:30"), Optional(86'400));
  EXPECT_THAT(seconds_of("1970-01-01T19:00:00-05:00"), Optional(86'400));
  EXPECT_THAT(seconds_of("1970-01-02T00:00:00Z"), Optional(86'400));
  for (const char* none : {"", "yesterday", "2026-11-21", "2026-11-21T12:39:03",
                           "2026-11-21T12:39:03+00:00x", "2026-11-21T12:39:03Zx"})
    EXPECT_EQ(seconds_of(none), std::nullopt) << none;
}

}  // namespace
}  // namespace fieldproof::history
