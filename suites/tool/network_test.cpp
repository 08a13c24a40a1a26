// The built tool and Modbus TCP: the same device in process, in another process behind a socket,
// and started by the bench; what is said where nothing answers; the capture of real connections.
#include <gmock/gmock.h>

#include <optional>
#include <sstream>

#include "harness/system/sockets/test_sockets.hpp"
#include "suites/tool/network_runs.hpp"

namespace fieldproof::tool_tests {
namespace {

using testing::AllOf;
using testing::AnyOf;
using testing::HasSubstr;
using testing::Not;

constexpr const char* plc = "xbc-h?protocol=modbus-tcp";
constexpr const char* protocol = "modbus-tcp";
constexpr const char* every_case = "modbus_tcp/*";

class Emulated : public EmulatedServer {
 public:
  explicit Emulated(const std::vector<std::string>& more = {}) : EmulatedServer(protocol, more) {}
};

const std::vector<NotThere> without_back_door{
    {"modbus_tcp/client/", "nothing makes the device ask: give --stimulus COMMAND"},
    {"modbus_tcp/bases/", "the profile declares "},
    {"modbus_tcp/bases/of_each_service", "needs a second line to the same device"},
    {"modbus_tcp/cnet_and_tcp/", "needs a second line to the same device"},
    {"modbus_tcp/connections/dedicated_", "needs connections = "},
    {"modbus_tcp/connections/vanished_place_is_free", "needs waiting_time = 2"},
    {"modbus_tcp/connections/waiting_time", "needs waiting_time = 2"},
    {"modbus_tcp/data/tcp_bit_in_word/", "needs bit_read_base = M1000"},
    {"modbus_tcp/data/tcp_fc", "needs bit_read_base = M1000"},
    {"modbus_tcp/data/tcp_stop", "cannot do "},
    {"modbus_tcp/driver/shown", "looks at the status counters"},
    {"modbus_tcp/mbap/counters", "looks at the status counters"},
    {"modbus_tcp/connections/power_cycle", "needs word_write_base = "},
    {"modbus_tcp/examples/read_discrete_inputs", "%PW11 is read only"},
    {"modbus_tcp/examples/read_input_registers", "%PW7 is read only"},
    {"modbus_tcp/limits/", "%PW0 is read only"},
    {"modbus_tcp/addressing/each_bit_of_bits/f02", "is read only"},
    {"modbus_tcp/addressing/each_bit_of_words/", "needs word_read_base = "},
    {"modbus_tcp/addressing/end_of_words_04/", "is read only"},
    {"modbus_tcp/addressing/four_tables_apart", "is read only"},
    {"modbus_tcp/addressing/last_bits/f02_", "is read only"},
    {"modbus_tcp/addressing/start_of_inputs", "is read only"},
    {"modbus_tcp/data/bits_02/", "is read only"},
    {"modbus_tcp/data/inputs_after_a_long_reply", "is read only"},
    {"modbus_tcp/data/words_04/", "is read only"},
    {"modbus_tcp/writes/inputs_stay", "is read only"},
};
/// What a real device may hold must be saved before it is written. One that the bench has started
/// itself forgets it with its process.
const std::vector<NotThere> not_saved{
    {"modbus_tcp/examples/write_", "it is beyond the area"},
    {"modbus_tcp/exceptions/last_address/", "it is beyond the area"},
    {"modbus_tcp/limits/write_words_refused/c07d8", "it is beyond the area"},
    {"modbus_tcp/addressing/coils_across_the_end", "it is beyond the area"},
    {"modbus_tcp/addressing/end_of_words_06/", "it is beyond the area"},
    {"modbus_tcp/addressing/end_of_words_10/", "it is beyond the area"},
    {"modbus_tcp/addressing/last_coil_forced", "it is beyond the area"},
    {"modbus_tcp/addressing/longest_words_to_the_end/", "it is beyond the area"},
    {"modbus_tcp/exceptions/address_of_a_", "it is beyond the area"},
    {"modbus_tcp/exceptions/address_of_coils/", "it is beyond the area"},
    {"modbus_tcp/exceptions/address_of_registers/", "it is beyond the area"},
    {"modbus_tcp/exceptions/byte_count_before_address_", "it is beyond the area"},
    {"modbus_tcp/exceptions/length_before_address/f0", "it is beyond the area"},
    {"modbus_tcp/exceptions/value_before_address", "it is beyond the area"},
};

/// Fields of each packet, by tshark without options; Wireshark's own findings are one of them.
std::vector<std::vector<std::string>> decoded(const std::string& capture,
                                              const std::vector<std::string>& names,
                                              const std::string& filter = "") {
  std::vector<std::string> arguments{"tshark", "-r", capture, "-T", "fields", "-E", "separator=/t"};
  if (!filter.empty()) arguments.insert(arguments.end(), {"-Y", filter});
  for (const std::string& name : names) arguments.insert(arguments.end(), {"-e", name});
  const Finished finished = run_program(arguments);
  EXPECT_EQ(finished.code, 0) << finished.err;
  std::vector<std::vector<std::string>> rows;
  std::istringstream lines(finished.out);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream cells(line);
    rows.emplace_back();
    for (std::string cell; std::getline(cells, cell, '\t');) rows.back().push_back(cell);
    rows.back().resize(names.size());
  }
  return rows;
}

/// Once in process, for all tests of this suite.
class ModbusTcp : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<TestFolder>();
    const Finished finished =
        run_on(*folder_, std::string("emulator:") + plc, "in_process", every_case);
    EXPECT_EQ(finished.code, 0) << finished.out << finished.err;
    in_process_ = read_results(*folder_ / "in_process/results.ndjson");
  }
  static void TearDownTestSuite() { folder_.reset(); }

  static inline std::unique_ptr<TestFolder> folder_;
  static inline Results in_process_;
};

TEST_F(ModbusTcp, in_another_process_as_in_process) {
  Emulated device;
  const Finished finished = run_on(*folder_, device.endpoint(), "tcp", every_case,
                                   {"--capture", *folder_ / "tcp.pcapng"});
  EXPECT_EQ(finished.code, 0) << finished.out << finished.err;
  std::vector<NotThere> reasons = without_back_door;
  reasons.insert(reasons.end(), not_saved.begin(), not_saved.end());
  expect_same_verdicts(in_process_, read_results(*folder_ / "tcp/results.ndjson"), reasons, 500);

  // The capture of that run: nothing is lost, doubled or out of order, and what is malformed the
  // case has made so: a length, or what a function code needs behind it.
  const std::string capture = *folder_ / "tcp.pcapng";
  for (const auto& row : decoded(capture, {"frame.number", "frame.comment"}, "tcp.analysis.flags"))
    ADD_FAILURE() << "packet " << row[0] << ", " << row[1];
  for (const auto& row : decoded(capture, {"frame.comment"}, "_ws.malformed"))
    EXPECT_THAT(row[0], AnyOf(HasSubstr("modbus_tcp/mbap/length_"),
                              HasSubstr("modbus_tcp/exceptions/length_"),
                              HasSubstr("modbus_tcp/exceptions/function_"),
                              HasSubstr("_no_byte_count"), HasSubstr("/words_odd")));
  const auto requests = decoded(capture, {"modbus.func_code"}, "mbtcp && tcp.dstport == 502");
  const auto replies = decoded(capture, {"modbus.func_code"}, "mbtcp && tcp.srcport == 502");
  EXPECT_GT(requests.size(), 500u);
  EXPECT_GT(replies.size(), 500u);
}

TEST_F(ModbusTcp, started_by_the_bench_as_in_process) {
  const Finished finished = run_on(*folder_,
                                   "exec:exec " + quoted(FIELDPROOF_TOOL) + " emulate " +
                                       quoted(plc) + " --tcp {port}?protocol=modbus-tcp",
                                   "exec", every_case);
  EXPECT_EQ(finished.code, 0) << finished.out << finished.err;
  expect_same_verdicts(in_process_, read_results(*folder_ / "exec/results.ndjson"),
                       without_back_door, 500);
}

TEST_F(ModbusTcp, a_printed_example_is_decoded_field_by_field) {
  Emulated device;
  const std::string capture = *folder_ / "example.pcapng";
  const Finished finished =
      run_on(*folder_, device.endpoint(), "example", "modbus_tcp/examples/read_holding_registers",
             {"--capture", capture});
  EXPECT_EQ(finished.code, 0) << finished.out << finished.err;
  // FEnet EN 5.3.5 (3)(d), table 5-23: three words from 006B, which hold 022B, 0000 and 0064.
  const auto rows =
      decoded(capture,
              {"mbtcp.len", "modbus.func_code", "modbus.reference_num", "modbus.word_cnt",
               "modbus.byte_cnt", "modbus.regnum16", "modbus.regval_uint16"},
              "mbtcp && frame.comment contains \"step\"");
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_THAT(rows[0], testing::ElementsAre("6", "3", "107", "3", "", "", ""));
  EXPECT_THAT(rows[1], testing::ElementsAre("9", "3", "", "", "6", "107,108,109", "555,0,100"));
}

TEST(ModbusTcpTrouble, a_refused_connection_speaks_of_port_and_host_table) {
  const TestFolder folder;
  const std::string where = "127.0.0.1:" + std::to_string(free_port());
  const Finished finished =
      run_on(folder, "tcp:" + where + "?protocol=modbus-tcp", "out", every_case);
  EXPECT_EQ(finished.code, 3);
  EXPECT_THAT(finished.err, AllOf(HasSubstr("tcp:" + where), HasSubstr("refused"),
                                  HasSubstr("port"), HasSubstr("table of hosts")));
  EXPECT_THAT(finished.err, AllOf(Not(HasSubstr("parity")), Not(HasSubstr("speed"))));
}

TEST(ModbusTcpTrouble, a_silent_device_speaks_of_address_firewall_and_connections) {
  const TestFolder folder;
  const os::UniqueFd silent = os::test::bound(SOCK_STREAM);  // takes connections, and no more
  const std::string where = "127.0.0.1:" + std::to_string(os::test::port_of(silent));
  const Finished finished =
      run_on(folder, "tcp:" + where + "?protocol=modbus-tcp", "out", every_case);
  EXPECT_EQ(finished.code, 3);
  EXPECT_THAT(finished.err,
              AllOf(HasSubstr("nothing answers on tcp:" + where), HasSubstr("address"),
                    HasSubstr("firewall"), HasSubstr("table of hosts"), HasSubstr("connection")));
  EXPECT_THAT(finished.err, AllOf(Not(HasSubstr("parity")), Not(HasSubstr("A and B"))));
}

TEST(ModbusTcpTrouble, a_host_that_is_not_there) {
  const TestFolder folder;
  const Finished finished =
      run_on(folder, "tcp:plc.invalid?protocol=modbus-tcp", "out", every_case);
  EXPECT_EQ(finished.code, 3);
  EXPECT_THAT(finished.err,
              AllOf(HasSubstr("cannot find host 'plc.invalid'"), HasSubstr("write its address")));
}

TEST(ModbusTcpTrouble, what_it_is_not_carried_by) {
  const auto expect = [](const std::vector<std::string>& arguments, const std::string& message) {
    const Finished finished = run_tool(arguments);
    EXPECT_EQ(finished.code, 2) << message;
    EXPECT_THAT(finished.err, HasSubstr(message));
  };
  expect({"emulate", plc}, "runs on a network; give --tcp 127.0.0.1:502, or another port");
  expect({"emulate", plc, "--udp", "15020"}, "it takes no datagrams; leave --udp out");
  expect({"emulate", plc, "--tcp", "127.0.0.1:65536"}, "'65536' is no port");
  expect({"run", "--endpoint", "serial:/dev/null?protocol=modbus-tcp", "--profile", "xbc-h"},
         "it runs on a network; write tcp:HOST");
}

TEST(ModbusTcpTrouble, a_port_in_use) {
  const os::UniqueFd taken = os::test::bound(SOCK_STREAM);
  const std::string where = "127.0.0.1:" + std::to_string(os::test::port_of(taken));
  const Finished finished = run_tool({"emulate", plc, "--tcp", where});
  EXPECT_EQ(finished.code, 3);
  EXPECT_THAT(finished.err,
              HasSubstr("cannot listen on " + where +
                        ": the port is in use; end the program that has it, or choose another"));
}

TEST(ModbusTcpEmulated, names_each_connection) {
  Emulated device({"-v"});
  os::UniqueFd one = os::test::connected(SOCK_STREAM, device.port());
  const os::UniqueFd two = os::test::connected(SOCK_STREAM, device.port());
  const std::string request("\x00\x01\x00\x00\x00\x06\x01\x03\x00\x63\x00\x01", 12);
  os::test::say(two, request);
  EXPECT_EQ(os::test::hear(two).size(), 11u);
  os::test::break_off(one);
  EXPECT_TRUE(device.process().wait_for("#1 127.0.0.1:"));
  EXPECT_TRUE(device.process().wait_for("received    12  00 01 00 00 00 06 01 03 00 63 00 01"));
  EXPECT_TRUE(device.process().wait_for("reset by the other side (RST)"));
  device.process().signal(SIGINT);
  const Finished finished = device.process().wait();
  EXPECT_EQ(finished.code, 0);
  EXPECT_THAT(finished.out, HasSubstr("#2 127.0.0.1:" + std::to_string(os::test::port_of(two)) +
                                      "  received    12"));
}

}  // namespace
}  // namespace fieldproof::tool_tests
