// A PLC that a second hand wrote in another language from the manuals and the decisions, without
// sight of vectors and emulator (device.py): healthy it passes, and single faults of it, made for
// no vector, are caught.
#include <gmock/gmock.h>

#include "suites/tool/tool_files.hpp"

namespace fieldproof::second_hand {
namespace {

using testing::HasSubstr;
using tool_tests::Finished;
using tool_tests::TestFolder;

struct Device {
  const char* protocol;
  const char* filter;  // what ends within seconds
  const char* where = " --tty {tty}";
};

void PrintTo(const Device& device, std::ostream* out) { *out << device.protocol; }

constexpr const char* of_a_port = " --listen 127.0.0.1:{port} --udp 127.0.0.1:{udp_port}";

std::string endpoint(const Device& device, const std::string& fault = "") {
  const bool network = std::string_view(device.where) != " --tty {tty}";
  return "exec:python3 -B " FIELDPROOF_SOURCE_DIR "/suites/second_hand/device.py --protocol " +
         std::string(device.protocol) + device.where + (fault.empty() ? "" : " --fault " + fault) +
         (network ? "?protocol=" + std::string(device.protocol) : "");
}

Finished judged(const Device& device, const std::string& fault, const TestFolder& folder) {
  return tool_tests::run_tool({"run", "--endpoint", endpoint(device, fault), "--protocol",
                               device.protocol, "--role", "server", "--filter", device.filter,
                               "--max-failures", "1", "--out", folder.path()});
}

class SecondHand : public testing::TestWithParam<Device> {};

TEST_P(SecondHand, AHealthyDeviceHasNoFalseAlarm) {
  const TestFolder folder;
  const Finished finished = judged(GetParam(), "", folder);
  EXPECT_EQ(finished.code, 0) << finished.out << finished.err;
  tool_tests::Results results = tool_tests::read_results(folder / "results.ndjson");
  EXPECT_GT(results.counts()["PASS"], 10u) << finished.out;
}

INSTANTIATE_TEST_SUITE_P(
    Protocols, SecondHand,
    testing::Values(
        Device{"xgt-cnet", "xgt_cnet/rs*:xgt_cnet/monitor*"},
        Device{"modbus-rtu", "modbus_rtu/examples/*"}, Device{"modbus-ascii", "modbus_ascii/*"},
        Device{"modbus-tcp", "modbus_tcp/examples/*:modbus_tcp/data/*:modbus_tcp/limits/*",
               " --listen 127.0.0.1:{port}"},
        Device{"xgt-fenet", "xgt_fenet/examples/*:xgt_fenet/read/*:xgt_fenet/write/*", of_a_port}),
    [](const auto& one) {
      std::string name = one.param.protocol;
      std::erase(name, '-');
      return name;
    });

TEST(SecondHandFaults, AreCaughtByRun) {
  for (const char* fault : {"cnet-bcc-ignored-wsb", "mem-d-alias", "cnet-count-16-refused"}) {
    const TestFolder folder;
    EXPECT_EQ(judged({"xgt-cnet", "xgt_cnet/*:-*/line/*:-*/timing/*"}, fault, folder).code, 1)
        << fault;
  }
}

/// As a real PLC, whose answers to what nobody prints are its own.
Finished explored(const Device& device, const std::string& fault, const char* requests,
                  const TestFolder& folder) {
  return tool_tests::run_tool({"explore", "--profile", "xbc-dxxxh", "--seed", "1", "--requests",
                               requests, "--fail-fast", "--protocol", device.protocol, "--endpoint",
                               endpoint(device, fault), "--out", folder.path()});
}

TEST_P(SecondHand, ExploringAHealthyDeviceHasNoFalseAlarm) {
  const TestFolder folder;
  const Finished finished = explored(GetParam(), "", "300", folder);
  EXPECT_EQ(finished.code, 0) << finished.out << finished.err;
}

/// It takes a history: no vector asks so often. Data of one word come with another.
TEST(SecondHandFaults, OfStateAreFoundByExploring) {
  const Device cnet{"xgt-cnet", ""};
  const TestFolder healthy, folder;
  const Finished none = explored(cnet, "", "2000", healthy);
  EXPECT_EQ(none.code, 0) << none.out << none.err;
  const Finished finished = explored(cnet, "mem-m-alias", "2000", folder);
  EXPECT_EQ(finished.code, 1) << finished.out << finished.err;
  EXPECT_THAT(finished.out,
              testing::AllOf(HasSubstr("shown again three times in a row"), HasSubstr("data")));
}

}  // namespace
}  // namespace fieldproof::second_hand
