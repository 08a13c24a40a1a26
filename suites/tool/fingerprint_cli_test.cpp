// The fingerprint of the bench file is compared before anything else.
#include <gmock/gmock.h>

#include "suites/tool/tool_files.hpp"

namespace fieldproof::tool_tests {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class FingerprintRuns : public testing::Test {
 protected:
  Finished run(const nlohmann::ordered_json& fingerprint,
               const std::vector<std::string>& more = {}) {
    const nlohmann::ordered_json device{
        {"endpoint", "emulator:xbc-h"}, {"profile", "xbc-h"}, {"fingerprint", fingerprint}};
    std::vector<std::string> arguments{
        "run",
        "--bench",
        folder_.write("bench.json", nlohmann::ordered_json{{"devices", {{"plc", device}}}}.dump()),
        "--dut",
        "plc",
        "--vectors",
        write_vectors(folder_, many_vectors(2)),
        "--out",
        folder_ / "out"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_tool(arguments);
  }
  TestFolder folder_;
};

TEST_F(FingerprintRuns, TheProbeTakesWhatTheRunFinds) {
  const Finished probe =
      run_tool({"probe", "emulator:xbc-h?line=38400-8E1&station=3", "--fingerprint"});
  EXPECT_EQ(probe.code, 0) << probe.err;
  const std::size_t start = probe.out.find("fingerprint ");
  ASSERT_NE(start, std::string::npos) << probe.out;
  const nlohmann::ordered_json taken =
      nlohmann::ordered_json::parse(probe.out.substr(probe.out.find('{', start)));
  EXPECT_EQ(taken["areas"], "CDFKLMNPRTU");
  EXPECT_EQ(taken["M"], "0-1023");
  const Finished finished = run(taken, {"--qualify"});
  EXPECT_EQ(finished.code, 0) << finished.err;
  EXPECT_EQ(read_results(folder_ / "out/results.ndjson").run["identity"]["fingerprint_found"]["D"],
            "0-10239");
  EXPECT_THAT(read_text(folder_ / "out/report.html"), Not(HasSubstr("(differs)")));
}

TEST_F(FingerprintRuns, AnotherDeviceStopsTheRun) {
  const Finished finished = run({{"M", "0-255"}, {"areas", "CDFKLMNPTU"}});
  EXPECT_EQ(finished.code, 3);
  EXPECT_THAT(finished.err, AllOf(HasSubstr("this is not the device 'plc' of the bench file"),
                                  HasSubstr("area M: 0-255 declared, 0-1023 found"),
                                  HasSubstr("areas CDFKLMNPTU declared, CDFKLMNPRTU found")));
  expect_reports(folder_ / "out");
  EXPECT_TRUE(read_results(folder_ / "out/results.ndjson").cases.empty());
  EXPECT_THAT(read_text(folder_ / "out/report.html"), HasSubstr("this is not the device"));
}

TEST_F(FingerprintRuns, WhatNoReadFindsIsRefused) {
  const Finished finished = run({{"aeras", "PML"}});
  EXPECT_EQ(finished.code, 2);
  EXPECT_THAT(finished.err, AllOf(HasSubstr("devices.plc: fingerprint.aeras"),
                                  HasSubstr("did you mean 'areas'?")));
}

}  // namespace
}  // namespace fieldproof::tool_tests
