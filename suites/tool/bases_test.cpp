// Devices whose Modbus bases are not those of the manual's default, by the built tool: cases move
// with what the profile declares, and a profile that does not declare it is told of by failures.
#include <gmock/gmock.h>

#include <fstream>
#include <memory>

#include "suites/tool/tool_files.hpp"

namespace fieldproof::tool_tests {
namespace {

using nlohmann::json;

/// A device of its own process, and the profile that is given to the bench.
struct Device {
  std::string name;
  std::string options;  // of the emulated PLC
  json declared;        // "config" of the profile
  std::size_t judged;   // cases that pass, at least
};

const json bits_at_p0{{"bit_write_base", "P0"}};
/// Cnet EN 6.1.3: the dialog of the settings as it is printed.
const json printed_dialog{{"bit_read_base", "M0"},
                          {"bit_write_base", "M0"},
                          {"word_read_base", "D0"},
                          {"word_write_base", "D0"}};

/// "&bit_write_base=P0"
std::string as_options(const json& bases) {
  std::string text;
  for (const auto& [key, base] : bases.items()) text += "&" + key + "=" + base.get<std::string>();
  return text;
}

std::vector<Device> devices() {
  return {{"bits_at_p0", as_options(bits_at_p0), bits_at_p0, 250},
          {"printed_dialog", as_options(printed_dialog), printed_dialog, 250},
          {"not_declared", as_options(bits_at_p0), json::object(), 100}};
}

std::unique_ptr<Process> run_against(const Device& device, const TestFolder& folder) {
  const json profile{{"name", device.name},         {"extends", "xbc-h"},
                     {"title", "of a test"},        {"model", "xbc-h"},
                     {"protocols", {"modbus-tcp"}}, {"config", device.declared}};
  folder.write(device.name + ".json", profile.dump());
  const std::string command = quoted(FIELDPROOF_TOOL) + " emulate " +
                              quoted("xbc-h?protocol=modbus-tcp" + device.options) +
                              " --tcp {port}";
  return std::make_unique<Process>(
      tool_arguments({"run", "--endpoint", "exec:" + command + "?protocol=modbus-tcp", "--profile",
                      folder / (device.name + ".json"), "--filter", "modbus_tcp/*", "--allow-write",
                      "all,P,Q,U", "--out", folder / device.name}));
}

/// The device of suites/second_hand, whose author has not seen our emulator, on a line.
std::unique_ptr<Process> run_on_a_line(const std::string& framing, const std::string& bases,
                                       const json& declared, const std::string& folder) {
  const std::string profile = folder + ".json";
  std::ofstream(profile) << json{{"name", "line"},
                                 {"extends", "xbc-h"},
                                 {"protocols", {"modbus-" + framing}},
                                 {"config", declared}};
  const std::string cases = "modbus_" + framing + "/";
  return std::make_unique<Process>(tool_arguments(
      {"run", "--endpoint",
       "exec:python3 -B " FIELDPROOF_SOURCE_DIR "/suites/second_hand/device.py --protocol modbus-" +
           framing + " --bases " + bases + " --tty {tty}",
       "--profile", profile, "--role", "server", "--out", folder, "--filter",
       cases + "examples/*:" + cases + "data/*0_n1*:" + cases + "addressing/each_bit_of_bits/*"}));
}

struct OnALine {
  const char* framing;
  const char* name;
  const char* bases;  // of the device: bits read and written, words read and written
  json declared;
  bool wrong = false;  // the profile declares others
};

/// A base is the same by another spelling, and what is not declared is as by default.
TEST(ModbusLineBases, CasesMoveWithWhatTheProfileDeclares) {
  std::vector<OnALine> lines;
  for (const char* framing : {"rtu", "ascii"}) {
    lines.push_back({framing, "dialog", "M0,M0,D0,D0", printed_dialog});
    lines.push_back({framing, "bits_at_p0", "P0,P0,P0,M0", bits_at_p0});
    lines.push_back({framing, "default", "P0,M0,P0,M0", json{{"bit_read_base", "P0"}}});
    lines.push_back({framing, "not_declared", "M0,M0,D0,D0", json::object(), true});
  }
  const TestFolder folder;
  std::vector<std::unique_ptr<Process>> runs;
  for (const OnALine& one : lines)
    runs.push_back(run_on_a_line(one.framing, one.bases, one.declared,
                                 folder / (std::string(one.framing) + one.name)));
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const OnALine& one = lines[i];
    const std::string name = std::string(one.framing) + one.name;
    const Finished finished = runs[i]->wait();
    const Results results = read_results(folder / (name + "/results.ndjson"));
    EXPECT_EQ(finished.code, one.wrong ? 1 : 0) << name << finished.out << finished.err;
    EXPECT_EQ(results.counts().contains("FAIL"), one.wrong) << name;
    if (!one.wrong) {
      EXPECT_GE(results.counts().at("PASS"), 15u) << name;
    }
    if (one.name == std::string("default")) {
      EXPECT_EQ(results.verdict("modbus_" + std::string(one.framing) +
                                "/addressing/each_bit_of_bits/f01"),
                "PASS")
          << "needs P0000 and M0000, which are the declared P0 and the M0 of who declares nothing";
    }
  }
}

/// Most of a run is waiting for silence: all at once.
TEST(ModbusTcpBases, CasesMoveWithWhatTheProfileDeclares) {
  const TestFolder folder;
  std::vector<std::unique_ptr<Process>> runs;
  for (const Device& device : devices()) runs.push_back(run_against(device, folder));
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const Device device = devices()[i];
    const Finished finished = runs[i]->wait(Process::Limit(280));
    const std::map<std::string, std::size_t> counts =
        read_results(folder / device.name + "/results.ndjson").counts();
    const auto count = [&](const char* verdict) {
      const auto found = counts.find(verdict);
      return found == counts.end() ? 0 : found->second;
    };
    const bool wrong = device.name == "not_declared";
    EXPECT_EQ(finished.code, wrong ? 1 : 0) << device.name << finished.out << finished.err;
    EXPECT_GE(count("PASS"), device.judged) << device.name;
    EXPECT_EQ(count("FAIL") > 0, wrong) << device.name << finished.out;
  }
}

}  // namespace
}  // namespace fieldproof::tool_tests
