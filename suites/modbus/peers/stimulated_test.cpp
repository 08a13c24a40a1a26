// Masters that nobody here has written, told by lines what to ask as `run --stimulus` tells them:
// each line must become the request that it names. The emulator hears them; -v prints what it
// hears.
#include <gmock/gmock.h>
#include <sys/stat.h>

#include "suites/modbus/peers/test_ports.hpp"
#include "suites/tool/tool.hpp"

namespace fieldproof::modbus_peers {
namespace {

using testing::HasSubstr;

struct Master {
  std::string name, mode, command;  // and the terminal, or the port
};

const std::string python =
    "/usr/bin/python3 " +
    tool_tests::quoted(FIELDPROOF_SOURCE_DIR "/suites/modbus/peers/pymodbus_stimulated.py");
const std::vector<Master> masters{
    {"libmodbus_rtu", "rtu", tool_tests::quoted(LIBMODBUS_STIMULATED)},
    {"pymodbus_rtu", "rtu", python + " rtu"},
    {"pymodbus_ascii", "ascii", python + " ascii"},
    {"libmodbus_tcp", "tcp", tool_tests::quoted(LIBMODBUS_STIMULATED) + " tcp"},
    {"pymodbus_tcp", "tcp", python + " tcp"}};

void PrintTo(const Master& master, std::ostream* out) { *out << master.name; }

/// The lines of blocks at rest, and the start of their PDUs.
struct Line {
  std::string block, values, pdu;
};
const std::vector<Line> lines{
    {R"("function":"write","command":"single","type":"word","size":1,"read":["%MW100"],"save":["0x40001"])",
     R"("%MW100":"1234")", "06 00 01 12 34"},
    {R"("function":"write","command":"continuous","type":"word","size":2,"read":["%DW0"],"save":["0x40002"])",
     R"("%DW0":"00010002")", "10 00 02 00 02 04 00 01 00 02"},
    {R"("function":"write","command":"single","type":"bit","size":1,"read":["%MX0001F"],"save":["0x00142"])",
     R"("%MX0001F":"01")", "05 01 42 FF 00"},
    {R"("function":"write","command":"continuous","type":"bit","size":3,"read":["%MX00020"],"save":["0x00150"])",
     R"("%MX00020":"010001")", "0F 01 50 00 03 01 05"},
    {R"("function":"read","command":"single","type":"word","size":1,"read":["0x40002"],"save":["%MW160"])",
     "", "03 00 02 00 01"},
    {R"("function":"read","command":"continuous","type":"word","size":4,"read":"0x30000","save":"%MW150")",
     "", "04 00 00 00 04"},
    {R"("function":"read","command":"single","type":"bit","size":1,"read":["0x00021"],"save":["%MX01701"])",
     "", "01 00 21 00 01"},
    {R"("function":"read","command":"continuous","type":"bit","size":16,"read":["0x100A0"],"save":["%MX01800"])",
     "", "02 00 A0 00 10"}};

/// As the wire has it: bytes, or the characters of ASCII.
std::string on_the_wire(const std::string& mode, const std::string& hex) {
  if (mode != "ascii") return "01 " + hex;
  std::string characters = "01" + hex;
  std::erase(characters, ' ');
  return ':' + characters;
}

std::string line_of(const std::string& block, const std::string& values, const std::string& flag) {
  return R"({"case":"c","block":{"block":0,"channel":1,"station":1,"flag":")" + flag + "\"," +
         block + R"(},"values":{)" + values + "}}\n";
}

class StimulatedMaster : public testing::TestWithParam<Master> {
 protected:
  tool_tests::TestFolder folder;
  const bool tcp = GetParam().mode == "tcp";
  const std::string where = tcp ? std::to_string(free_port()) : folder / "plc";
  tool_tests::Process plc{
      tool_tests::tool_arguments({"emulate", "xbc-h?protocol=modbus-" + GetParam().mode,
                                  tcp ? "--tcp" : "--pty", where, "-v"})};
};

INSTANTIATE_TEST_SUITE_P(Masters, StimulatedMaster, testing::ValuesIn(masters),
                         [](const auto& test) { return test.param.name; });

TEST_P(StimulatedMaster, AsksWhatTheLinesSay) {
  ASSERT_TRUE(plc.wait_for(where));
  std::string text;
  for (const Line& line : lines) text += line_of(line.block, line.values, "%MX00000");
  const std::string input = folder.write("lines.json", text);
  const tool_tests::Finished master =
      tool_tests::run_program({"/bin/sh", "-c",
                               "exec " + GetParam().command + ' ' + tool_tests::quoted(where) +
                                   " < " + tool_tests::quoted(input)});
  EXPECT_EQ(master.code, 0);
  EXPECT_EQ(master.err, "") << "every request was answered";
  plc.signal(SIGTERM);
  const tool_tests::Finished heard = plc.wait();
  for (const Line& line : lines)
    EXPECT_THAT(heard.out, HasSubstr(on_the_wire(GetParam().mode, line.pdu))) << line.block;
}

TEST_P(StimulatedMaster, AsksAtThePaceOfAClockUntilItIsOver) {
  ASSERT_TRUE(plc.wait_for(where));
  const std::string clock = line_of(lines[4].block, "", "F92"),
                    once = line_of(lines[6].block, "", "%MX00000");
  const std::string over = R"({"case":"c","over":true})"
                           "\n";
  const std::string pipe = folder / "lines";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  tool_tests::Process master({"/bin/sh", "-c",
                              "exec " + GetParam().command + ' ' + tool_tests::quoted(where) +
                                  " < " + tool_tests::quoted(pipe)});
  const int lines_in = ::open(pipe.c_str(), O_WRONLY | O_CLOEXEC);
  const auto tell = [lines_in](const std::string& line) {
    return ::write(lines_in, line.data(), line.size()) == static_cast<ssize_t>(line.size());
  };
  EXPECT_TRUE(tell(clock));
  ASSERT_TRUE(plc.wait_for(on_the_wire(GetParam().mode, lines[4].pdu)));
  EXPECT_TRUE(tell(over + once));
  ASSERT_TRUE(plc.wait_for(on_the_wire(GetParam().mode, lines[6].pdu)));
  ::close(lines_in);
  EXPECT_EQ(master.wait().code, 0);
}

/// As a device under test in the client role: the bench is the partner, and tells it on its
/// standard input what to ask.
TEST_P(StimulatedMaster, IsJudgedByTheBench) {
  const std::string vectors = FIELDPROOF_SOURCE_DIR "/suites/modbus/peers/stimulated_vectors.json";
  const tool_tests::Finished run =
      tool_tests::run_tool({"run", "--role", "client", "--vectors", vectors, "--filter",
                            "modbus_" + GetParam().mode + "/*", "--stimulus", "-", "--endpoint",
                            "exec:exec " + GetParam().command + (tcp ? " {port}" : " {tty}") +
                                "?station=0&protocol=modbus-" + GetParam().mode,
                            "--profile", "xbc-h", "--out", folder / "out"});
  EXPECT_EQ(run.code, 0) << run.out << run.err;
  EXPECT_THAT(run.out, HasSubstr("  4  PASS"));
}

}  // namespace
}  // namespace fieldproof::modbus_peers
