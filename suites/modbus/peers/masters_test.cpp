// Masters that nobody here has written, against the emulator: what they write one way they read
// another.
#include <gmock/gmock.h>

#include <map>
#include <sstream>

#include "suites/modbus/peers/test_ports.hpp"
#include "suites/tool/tool.hpp"

namespace fieldproof::modbus_peers {

using tool_tests::Finished;

namespace {

using testing::HasSubstr;

const std::string folder_of_peers = FIELDPROOF_SOURCE_DIR "/suites/modbus/peers/";

/// The emulator on a pty or on a port, ready when it has said where.
class EmulatedPlc {
 public:
  explicit EmulatedPlc(const std::string& mode)
      : where(mode == "tcp" ? std::to_string(free_port()) : folder_ / "plc"),
        emulator_(tool_tests::tool_arguments({"emulate", "xbc-h?protocol=modbus-" + mode,
                                              mode == "tcp" ? "--tcp" : "--pty", where})) {
    EXPECT_TRUE(emulator_.wait_for(where));
  }

 private:
  tool_tests::TestFolder folder_;

 public:
  const std::string where;  // the terminal, or the port

 private:
  tool_tests::Process emulator_;
};

void expect_no_complaint(const Finished& master) {
  EXPECT_EQ(master.code, 0) << master.out << master.err;
}

/// mbpoll's "[100]:   0x1234" lines by data address.
std::map<std::string, std::string> values(const std::string& output) {
  std::map<std::string, std::string> result;
  std::istringstream lines(output);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t end = line.find("]:");
    if (line.empty() || line[0] != '[' || end == std::string::npos) continue;
    std::istringstream(line.substr(end + 2)) >> result[line.substr(1, end - 1)];
  }
  return result;
}

class Mbpoll : public testing::TestWithParam<std::string> {
 protected:
  /// `what` says type and reference; `written` are the values to write, none to read.
  Finished mbpoll(std::vector<std::string> what, std::vector<std::string> written = {}) const {
    std::vector<std::string> arguments{"mbpoll", "-m", GetParam(), "-a", "1", "-0", "-1"};
    const bool tcp = GetParam() == "tcp";
    const std::vector<std::string> line{"-b", "9600", "-P", "none"}, port{"-p", plc.where};
    arguments.insert(arguments.end(), tcp ? port.begin() : line.begin(),
                     tcp ? port.end() : line.end());
    arguments.insert(arguments.end(), what.begin(), what.end());
    arguments.push_back(tcp ? "127.0.0.1" : plc.where);
    arguments.insert(arguments.end(), written.begin(), written.end());
    return tool_tests::run_program(arguments);
  }

  const EmulatedPlc plc{GetParam()};
};

TEST_P(Mbpoll, ReadsBitsOfTheWordsThatItWrote) {
  expect_no_complaint(mbpoll({"-t", "4:hex", "-r", "100"}, {"0x9ABC", "0x1234"}));
  const Finished coils = mbpoll({"-t", "0", "-r", "1600", "-c", "16"});
  expect_no_complaint(coils);
  const std::map<std::string, std::string> bits = values(coils.out);
  ASSERT_EQ(bits.size(), 16u) << coils.out;
  for (unsigned i = 0; i < 16; ++i)
    EXPECT_EQ(bits.at(std::to_string(1600 + i)), 0x9ABCu >> i & 1 ? "1" : "0") << i;
}

TEST_P(Mbpoll, ReadsTheWordOfTheBitsThatItWrote) {
  expect_no_complaint(
      mbpoll({"-t", "0", "-r", "3200"}, {"1", "0", "1", "1", "0", "0", "1", "1", "1", "0"}));
  const Finished word = mbpoll({"-t", "4:hex", "-r", "200", "-c", "1"});
  expect_no_complaint(word);
  EXPECT_EQ(values(word.out)["200"], "0x01CD") << word.out;
}

TEST_P(Mbpoll, IsToldOfAnAddressPastTheEnd) {
  const Finished refused = mbpoll({"-t", "4:hex", "-r", "1024", "-c", "1"});
  EXPECT_THAT(refused.out + refused.err, HasSubstr("Illegal data address"));
}

INSTANTIATE_TEST_SUITE_P(Modes, Mbpoll, testing::Values("rtu", "tcp"),
                         [](const auto& test) { return test.param; });

class Libmodbus : public testing::TestWithParam<std::string> {};

TEST_P(Libmodbus, WritesOneWayAndReadsAnother) {
  const EmulatedPlc plc(GetParam());
  std::vector<std::string> command{LIBMODBUS_CLIENT, plc.where};
  if (GetParam() == "tcp") command.insert(command.begin() + 1, "tcp");
  expect_no_complaint(tool_tests::run_program(command));
}

INSTANTIATE_TEST_SUITE_P(Modes, Libmodbus, testing::Values("rtu", "tcp"),
                         [](const auto& test) { return test.param; });

class Pymodbus : public testing::TestWithParam<std::string> {};

TEST_P(Pymodbus, WritesOneWayAndReadsAnother) {
  const EmulatedPlc plc(GetParam());
  expect_no_complaint(tool_tests::run_program(
      {"/usr/bin/python3", folder_of_peers + "pymodbus_client.py", GetParam(), plc.where}));
}

INSTANTIATE_TEST_SUITE_P(Modes, Pymodbus, testing::Values("rtu", "ascii", "tcp"),
                         [](const auto& test) { return test.param; });

}  // namespace
}  // namespace fieldproof::modbus_peers
