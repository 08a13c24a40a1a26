// Our P2P clients against servers that nobody here has written: `emulate --p2p` asks, libmodbus and
// pymodbus answer. What a block writes one way another reads another way.
#include <gmock/gmock.h>
#include <sys/socket.h>

#include <nlohmann/json.hpp>

#include "suites/modbus/peers/test_ports.hpp"
#include "suites/tool/tool.hpp"

namespace fieldproof::modbus_peers {
namespace {

using nlohmann::json;

const std::string folder_of_servers = FIELDPROOF_SOURCE_DIR "/suites/modbus/peers/";

/// The back door of an emulator in another process (harness/endpoints/set_up/device_control.hpp).
class BackDoor {
 public:
  BackDoor() {
    EXPECT_EQ(::socketpair(AF_UNIX, SOCK_STREAM, 0, ends_.data()), 0);
    ::fcntl(ends_[0], F_SETFD, FD_CLOEXEC);
    const timeval limit{60, 0};
    ::setsockopt(ends_[0], SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
  }
  ~BackDoor() {
    for (const int end : ends_)
      if (end >= 0) ::close(end);
  }
  BackDoor(const BackDoor&) = delete;
  BackDoor& operator=(const BackDoor&) = delete;

  std::string far_end() const { return std::to_string(ends_[1]); }
  /// The emulator has it; its end is heard from now on.
  void given_away() { ::close(std::exchange(ends_[1], -1)); }

  json ask(const json& request) {
    const std::string line = request.dump() + '\n';
    EXPECT_EQ(::send(ends_[0], line.data(), line.size(), MSG_NOSIGNAL),
              static_cast<ssize_t>(line.size()));
    std::string answer;
    for (char c = 0; c != '\n' && ::recv(ends_[0], &c, 1, 0) == 1;) answer += c;
    const json parsed = json::parse(answer, nullptr, false);
    EXPECT_TRUE(parsed.is_object() && !parsed.contains("error")) << line << answer;
    return parsed;
  }
  void set(const std::string& address, const std::string& hex) { ask({{"set", {{address, hex}}}}); }
  std::string get(const std::string& address, std::size_t digits = 0) {
    return ask({{"get", {{address, digits}}}})["values"].value(address, "");
  }

 private:
  std::array<int, 2> ends_{-1, -1};
};

json block(const char* function, const char* type, const char* read, const char* save,
           int size = 0) {
  json made{{"function", function}, {"flag", "%MX00000"}, {"type", type},
            {"read", read},         {"save", save},       {"station", 1}};
  if (size == 0) return made;
  made["command"] = "continuous";
  made["size"] = size;
  return made;
}

/// Block 0 knocks until the server is up, the last one shows that those before it are done. By TCP
/// the server is at `port`.
json parameters(std::uint16_t port) {
  json knock = block("read", "word", "0x40000", "%MW300");
  knock["flag"] = "F93";
  const json blocks{
      knock,
      block("write", "word", "%MW100", "0x40064"),
      block("write", "word", "%DW0", "0x40065", 4),
      block("write", "bit", "%MX0001F", "0x00C81"),
      block("write", "bit", "%MX01010", "0x00CA0", 20),
      block("read", "bit", "0x00640", "%MX02000", 32),  // the words of blocks 1 and 2
      block("read", "word", "0x400C8", "%MW210", 4),    // the bits of blocks 3 and 4
      block("read", "word", "0x30064", "%MW220"),       // input registers are the same words
      block("read", "bit", "0x10C81", "%MX02300"),      // and inputs the same bits
      block("read", "word", "0x4FFF0", "%MW240"),       // exception 02
      block("read", "word", "0x400FE", "%MW301")};
  if (port != 0) return {{"p2p", {{"blocks", blocks}, {"partner", "127.0.0.1"}, {"port", port}}}};
  return {{"time_out", 20}, {"p2p", {{"blocks", blocks}}}};
}

struct Server {
  std::string name, mode;
  std::vector<std::string> command;  // and the terminal, or the port
};

const std::vector<Server> servers{
    {"libmodbus_rtu", "rtu", {LIBMODBUS_SERVER}},
    {"pymodbus_rtu", "rtu", {"/usr/bin/python3", folder_of_servers + "pymodbus_server.py", "rtu"}},
    {"pymodbus_ascii",
     "ascii",
     {"/usr/bin/python3", folder_of_servers + "pymodbus_server.py", "ascii"}},
    {"libmodbus_tcp", "tcp", {LIBMODBUS_SERVER, "tcp"}},
    {"pymodbus_tcp", "tcp", {"/usr/bin/python3", folder_of_servers + "pymodbus_server.py", "tcp"}}};

void PrintTo(const Server& server, std::ostream* out) { *out << server.name; }

class P2pMaster : public testing::TestWithParam<Server> {
 protected:
  std::string result_of(unsigned number) {
    return plc.get("%LW" + std::to_string(512 + 6 * number), 4) + ' ' +
           plc.get("%LW" + std::to_string(513 + 6 * number), 4);
  }

  tool_tests::TestFolder folder;
  BackDoor plc;
};

INSTANTIATE_TEST_SUITE_P(Servers, P2pMaster, testing::ValuesIn(servers),
                         [](const auto& test) { return test.param.name; });

TEST_P(P2pMaster, IsAnsweredByAServerOfOthers) {
  const std::uint16_t port = GetParam().mode == "tcp" ? free_port() : 0;
  const std::string tty = folder / "plc";
  std::vector<std::string> asks{"emulate",   "xbc-h?protocol=modbus-" + GetParam().mode,
                                "--p2p",     folder.write("p2p.json", parameters(port).dump()),
                                "--control", plc.far_end(),
                                "-v"};
  if (port == 0) asks.insert(asks.end(), {"--pty", tty});
  tool_tests::Process master(tool_tests::tool_arguments(asks));
  plc.given_away();
  ASSERT_NE(plc.get("%MW0"), "") << master.wait().err;  // an answer: the terminal is there
  plc.set("%MW100", "9ABC");
  plc.set("%DW0", "123400FF8001A55A");
  plc.set("%MX0001F", "01");
  plc.set("%MW101", "81CD0005");
  std::vector<std::string> command = GetParam().command;
  command.push_back(port == 0 ? tty : std::to_string(port));
  const tool_tests::Process server(command);
  ASSERT_TRUE(master.wait_for("received")) << "nobody answers the first block";
  plc.set("%MX00000", "01");
  const bool ascii = GetParam().mode == "ascii";
  const std::string last_request =
      ascii ? "3A 30 31 30 33 30 30 46 45 30 30 30 31" : "01 03 00 FE 00 01";
  ASSERT_TRUE(master.wait_for(last_request));

  for (unsigned number = 1; number <= 8; ++number)
    EXPECT_EQ(result_of(number), "0001 0000") << "block " << number;
  EXPECT_EQ(result_of(9), "0002 000F");
  EXPECT_EQ(plc.get("%MW200", 8), "9ABC1234");
  EXPECT_EQ(plc.get("%MW210", 16), "0002000081CD0005");
  EXPECT_EQ(plc.get("%MW220"), "9ABC");
  EXPECT_EQ(plc.get("%MX02300"), "01");
  EXPECT_EQ(plc.get("%MW240"), "0000");
}

}  // namespace
}  // namespace fieldproof::modbus_peers
