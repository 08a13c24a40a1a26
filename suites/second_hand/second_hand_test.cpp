// A PLC, an inverter and a P2P client that a second hand wrote in another language from the manuals
// and the decisions, without sight of vectors and emulator (device.py, client.py): healthy they
// pass, and single faults of them, made for no vector, are caught.
#include <gmock/gmock.h>

#include <list>

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
  const char* profile = "xbc-h";
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
                               "--max-failures", "1", "--profile", device.profile, "--out",
                               folder.path()});
}

class SecondHand : public testing::TestWithParam<Device> {};

TEST_P(SecondHand, AHealthyDeviceHasNoFalseAlarm) {
  const TestFolder folder;
  const Finished finished = judged(GetParam(), "", folder);
  EXPECT_EQ(finished.code, 0) << finished.out << finished.err;
  tool_tests::Results results = tool_tests::read_results(folder / "results.ndjson");
  EXPECT_GT(results.counts()["PASS"], 10u) << finished.out;
}

constexpr Device devices[] = {
    {"xgt-cnet", "xgt_cnet/rs*:xgt_cnet/monitor*"},
    {"modbus-rtu", "modbus_rtu/examples/*"},
    {"modbus-ascii", "modbus_ascii/*"},
    {"modbus-tcp", "modbus_tcp/examples/*:modbus_tcp/data/*:modbus_tcp/limits/*",
     " --listen 127.0.0.1:{port}"},
    {"xgt-fenet", "xgt_fenet/examples/*:xgt_fenet/read/*:xgt_fenet/write/*", of_a_port},
    {"ls-bus", "ls_bus/read/*:ls_bus/write/*:ls_bus/errors/*", " --tty {tty}", "inverter"}};

INSTANTIATE_TEST_SUITE_P(Protocols, SecondHand, testing::ValuesIn(devices), [](const auto& one) {
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

TEST(SecondHandFaults, OfAnInverterAreCaughtByRun) {
  for (const char* fault : {"ls-sum-low-digit", "ls-8000-alias"}) {
    const TestFolder folder;
    EXPECT_EQ(judged({"ls-bus", "ls_bus/*", " --tty {tty}", "inverter"}, fault, folder).code, 1)
        << fault;
  }
}

/// It asks what a line of --stimulus names.
Finished client_judged(const std::string& filter, const std::string& fault,
                       const TestFolder& folder) {
  const std::string client = "exec:python3 -B " FIELDPROOF_SOURCE_DIR
                             "/suites/second_hand/client.py --protocol xgt-cnet --tty {tty}";
  return tool_tests::run_tool({"run", "--role", "client", "--endpoint",
                               client + (fault.empty() ? "" : " --fault " + fault), "--stimulus",
                               "-", "--protocol", "xgt-cnet", "--filter", filter, "--max-failures",
                               "1", "--out", folder.path()});
}

TEST(SecondHandClient, HealthyItHasNoFalseAlarm) {
  const TestFolder folder;
  const Finished finished = client_judged("xgt_cnet/client/read/*", "", folder);
  EXPECT_EQ(finished.code, 0) << finished.out << finished.err;
  tool_tests::Results results = tool_tests::read_results(folder / "results.ndjson");
  EXPECT_GT(results.counts()["PASS"], 10u) << finished.out;
}

TEST(SecondHandClient, AFaultIsCaught) {
  const TestFolder folder;
  EXPECT_EQ(client_judged("xgt_cnet/client/read/*", "station-decimal", folder).code, 1);
}

/// As a real PLC, whose answers to what nobody prints are its own.
std::vector<std::string> exploring(const Device& device, const std::string& fault,
                                   const char* requests, const std::string& out) {
  const bool own = std::string_view(device.profile) != "xbc-h";
  return tool_tests::tool_arguments({"explore", "--profile", own ? device.profile : "xbc-dxxxh",
                                     "--seed", "1", "--requests", requests, "--fail-fast",
                                     "--protocol", device.protocol, "--endpoint",
                                     endpoint(device, fault), "--out", out});
}

/// All at once: they wait more than they work.
TEST(SecondHandExplored, AHealthyDeviceHasNoFalseAlarm) {
  const TestFolder folder;
  std::list<tool_tests::Process> runs;
  for (const Device& device : devices)
    runs.emplace_back(exploring(device, "", "200", folder / device.protocol));
  for (tool_tests::Process& run : runs) {
    const Finished finished = run.wait();
    EXPECT_EQ(finished.code, 0) << finished.out << finished.err;
  }
}

/// It takes a history: no vector asks so often. Data of one word come with another.
TEST(SecondHandFaults, OfStateAreFoundByExploring) {
  const TestFolder folder;
  tool_tests::Process healthy(exploring(devices[0], "", "2000", folder / "healthy")),
      faulty(exploring(devices[0], "mem-m-alias", "2000", folder / "faulty"));
  const Finished none = healthy.wait(), finished = faulty.wait();
  EXPECT_EQ(none.code, 0) << none.out << none.err;
  EXPECT_EQ(finished.code, 1) << finished.out << finished.err;
  EXPECT_THAT(finished.out,
              testing::AllOf(HasSubstr("shown again three times in a row"), HasSubstr("data")));
}

}  // namespace
}  // namespace fieldproof::second_hand
