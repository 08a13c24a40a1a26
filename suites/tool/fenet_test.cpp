// The built tool and XGT FEnet: the same device in process and in another process behind sockets,
// the search for servers, and the client of the README.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <unistd.h>

#include <fstream>

#include "harness/system/fd_link.hpp"
#include "harness/system/test_link.hpp"
#include "src/base/bytes.hpp"
#include "suites/tool/network_runs.hpp"

namespace fieldproof::tool_tests::fenet {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

constexpr const char* plc = "xbc-h?protocol=xgt-fenet";

/// With a port for datagrams.
class Fenet {
 public:
  explicit Fenet(std::vector<std::string> more = {}) : udp_(free_port(SOCK_DGRAM)) {
    more.insert(more.end(), {"--udp", std::to_string(udp_)});
    server_.emplace("xgt-fenet", more);
  }
  std::string endpoint() const { return server_->endpoint() + "&udp=" + std::to_string(udp_); }
  std::uint16_t port() const { return server_->port(); }
  Process& process() { return server_->process(); }

 private:
  std::uint16_t udp_;
  std::optional<EmulatedServer> server_;
};

/// What sockets can change; the rest asks the same often, which takes most of the time.
constexpr const char* most =
    "xgt_fenet/examples/*:xgt_fenet/header/*:xgt_fenet/read/*:xgt_fenet/connections/*:"
    "xgt_fenet/segments/*:xgt_fenet/udp/*:xgt_fenet/driver/*:xgt_fenet/status/*:"
    "xgt_fenet/host_table/*:xgt_fenet/cnet_and_fenet/*:xgt_fenet/length/d*:"
    "-*/ten_in_a_row/*:-*_counts/*:-*/split/*:-*/company_id_wrong/*:-*_in_mid_frame/*:-*/idle:-*/"
    "split_write/*";

const std::vector<NotThere> without_back_door{
    {"xgt_fenet/cnet_and_fenet/", "needs a second line to the same device"},
    {"xgt_fenet/cnet_and_fenet/flag_by_", "nothing makes the device ask"},
    {"xgt_fenet/connections/dedicated_", "needs connections = "},
    {"xgt_fenet/connections/power_cycle", "cannot do power_cycle"},
    {"xgt_fenet/connections/vanished_place_is_free", "needs waiting_time = 2"},
    {"xgt_fenet/connections/waiting_time", "needs waiting_time = "},
    {"xgt_fenet/header/check_", "the profile declares nothing"},
    {"xgt_fenet/header/plc_info_error/", "needs error = true"},
    {"xgt_fenet/header/plc_info_follows_the_mode", "cannot do stop"},
    {"xgt_fenet/header/plc_info_stop/", "needs mode = stop"},
    {"xgt_fenet/header/position_of_re", "needs base = "},
    {"xgt_fenet/host_table/", "needs host_table = "},
    {"xgt_fenet/read/in_stop", "needs mode = stop"},
    {"xgt_fenet/read/mixed_areas_xbc_h", "is read only over the protocol"},
    {"xgt_fenet/status/", "looks at the status counters"},
    {"xgt_fenet/status/medium_host_table", "needs host_table = "},
    {"xgt_fenet/status/slot", "needs slot = "},
};

TEST(XgtFenet, in_another_process_as_in_process) {
  const TestFolder folder;
  const Finished in_process = run_on(folder, std::string("emulator:") + plc, "in_process", most);
  EXPECT_EQ(in_process.code, 0) << in_process.out << in_process.err;
  Fenet device;
  const Finished over_sockets = run_on(folder, device.endpoint(), "tcp", most);
  EXPECT_EQ(over_sockets.code, 0) << over_sockets.out << over_sockets.err;
  expect_same_verdicts(read_results(folder / "in_process/results.ndjson"),
                       read_results(folder / "tcp/results.ndjson"), without_back_door, 150);
}

TEST(XgtFenetProbe, finds_the_server_and_its_limits) {
  Fenet device;
  const Finished finished = run_tool({"probe", device.endpoint(), "--fingerprint"});
  EXPECT_EQ(finished.code, 0) << finished.err;
  EXPECT_THAT(finished.out, AllOf(HasSubstr("xgt-fenet over TCP"), HasSubstr("xgt-fenet over UDP"),
                                  HasSubstr("bytes of a continuous read: 512, as printed"),
                                  HasSubstr("blocks of a read: 16, as printed"),
                                  HasSubstr("fieldproof run --endpoint")));
  EXPECT_THAT(finished.out, HasSubstr("\"areas\""));
}

TEST(XgtFenetProbe, finds_a_server_at_any_port_and_names_a_module) {
  Fenet device;
  const Finished fenet = run_tool({"probe", "tcp:127.0.0.1:" + std::to_string(device.port())});
  EXPECT_EQ(fenet.code, 0) << fenet.err;
  EXPECT_THAT(fenet.out, AllOf(HasSubstr("found         xgt-fenet over TCP"),
                               HasSubstr("--profile xbc-dxxxh\n"), Not(HasSubstr("bias"))));
  EmulatedServer modbus("modbus-tcp");
  const Finished other = run_tool({"probe", "tcp:127.0.0.1:" + std::to_string(modbus.port())});
  EXPECT_EQ(other.code, 0) << other.err;
  EXPECT_THAT(other.out, AllOf(HasSubstr("found         modbus-tcp over TCP"),
                               HasSubstr("--profile xbc-dxxxh\n"), Not(HasSubstr("other server"))));
}

TEST(XgtFenetProbe, a_datagram_port_is_of_one_protocol_and_may_refuse) {
  const std::uint16_t none = free_port(SOCK_DGRAM);
  Fenet device;
  const std::string at = "tcp:127.0.0.1:" + std::to_string(device.port());
  const Finished refused =
      run_tool({"probe", at + "?protocol=xgt-fenet&udp=" + std::to_string(none)});
  EXPECT_EQ(refused.code, 0) << refused.err;
  EXPECT_THAT(refused.out, AllOf(HasSubstr("refused       xgt-fenet over UDP"),
                                 Not(HasSubstr("connection is taken"))));
  const Finished fenet_only = run_tool({"probe", "tcp:127.0.0.1?udp=2005", "--wait", "100"});
  EXPECT_THAT(fenet_only.out,
              AllOf(HasSubstr("xgt-fenet over UDP"), Not(HasSubstr("modbus-tcp over UDP"))));
}

TEST(XgtFenetProbe, says_what_is_in_the_way) {
  const auto probe = [](const std::string& endpoint) {
    const Finished finished = run_tool({"probe", endpoint, "--wait", "200"});
    EXPECT_EQ(finished.code, 1) << finished.out << finished.err;
    return finished.out;
  };
  const std::string nobody = "tcp:127.0.0.1:" + std::to_string(free_port());
  EXPECT_THAT(probe(nobody + "?protocol=xgt-fenet"),
              AllOf(HasSubstr("refused"), HasSubstr("nothing listens there"),
                    HasSubstr("one server driver")));
  const os::UniqueFd silent = os::test::bound(SOCK_STREAM);
  EXPECT_THAT(
      probe("tcp:127.0.0.1:" + std::to_string(os::test::port_of(silent)) + "?protocol=xgt-fenet"),
      AllOf(HasSubstr("silence"), HasSubstr("nothing is answered")));
  EmulatedServer modbus("modbus-tcp");
  EXPECT_THAT(probe("tcp:127.0.0.1:" + std::to_string(modbus.port()) + "?protocol=xgt-fenet"),
              AllOf(HasSubstr("a server of modbus-tcp answers there"),
                    HasSubstr("add protocol=modbus-tcp"), Not(HasSubstr("go on with"))));
}

TEST(XgtFenetProbe, a_place_taken_and_a_host_table_are_told_apart_by_datagrams) {
  const TestFolder folder;
  const auto probe = [&](const std::string& config, bool take) {
    const std::uint16_t tcp = free_port(), udp = free_port(SOCK_DGRAM);
    Process process(tool_arguments({"emulate", plc, "--config", folder.write("plc.json", config),
                                    "--tcp", std::to_string(tcp), "--udp", std::to_string(udp)}));
    EXPECT_TRUE(process.wait_for("tcp 127.0.0.1:"));
    const os::UniqueFd first = take ? os::test::connected(SOCK_STREAM, tcp) : os::UniqueFd();
    const std::string endpoint =
        "tcp:127.0.0.1:" + std::to_string(tcp) + "?protocol=xgt-fenet&udp=" + std::to_string(udp);
    const Finished run = run_tool({"run", "--endpoint", endpoint, "--profile", "xbc-dxxxh",
                                   "--filter", "xgt_fenet/examples/read_word"});
    EXPECT_THAT(run.out + run.err,
                AllOf(HasSubstr("takes a connection and ends it"), HasSubstr("table of hosts"),
                      Not(HasSubstr("nothing listens"))));
    return run_tool({"probe", endpoint, "--wait", "200"}).out;
  };
  EXPECT_THAT(probe(R"({"connections": 1})", true),
              AllOf(HasSubstr("ended         xgt-fenet over TCP"),
                    HasSubstr("all channels are taken"), Not(HasSubstr("lacks the address"))));
  EXPECT_THAT(probe(R"({"host_table": ["203.0.113.7"]})", false),
              AllOf(HasSubstr("ended         xgt-fenet over TCP"),
                    HasSubstr("most likely the host table")));
}

/// The Python of README.md, as it stands there but for the port.
std::string client_of_the_readme(std::uint16_t port) {
  const std::string text = read_text(FIELDPROOF_SOURCE_DIR "/README.md");
  constexpr std::string_view begin = "```python\nimport socket, struct\n";
  const std::size_t at = text.find(begin);
  EXPECT_NE(at, text.npos);
  const std::size_t code = text.find('\n', at) + 1;
  std::string client = text.substr(code, text.find("```", code) - code);
  EXPECT_EQ(std::ranges::count(client, '\n'), 4);
  const std::size_t number = client.find("2004");
  EXPECT_NE(number, client.npos);
  return client.replace(number, 4, std::to_string(port));
}

/// One word, written over Cnet: "WSS" of %MW100 at station 1, and its acknowledgement.
const std::string write_over_cnet =
    "\x05"
    "01WSS0106%MW1001234\x04";
const std::string written_over_cnet =
    "\x06"
    "01WSS\x03";

TEST(XgtFenetEmulated, has_a_cnet_line_beside_its_network) {
  const TestFolder folder;
  const std::string link = folder / "plc",
                    config =
                        folder.write("plc.json", R"({"services": {"xgt-cnet": {"station": 1}}})");
  Fenet device({"--pty", link, "--config", config});
  os::FdLink line(os::UniqueFd(::open(link.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK)), "the line");
  ASSERT_TRUE(line.send(to_bytes(write_over_cnet)));
  EXPECT_EQ(os::test::receive_text(line, "\x03"), written_over_cnet);
  const Finished client = run_program({"python3", "-c", client_of_the_readme(device.port())});
  EXPECT_EQ(client.out, "4660\n") << client.err << "one memory";
}

TEST(XgtFenetEmulated, a_line_wants_a_service_and_a_service_its_line) {
  const TestFolder folder;
  const std::string
      cnet = folder.write("cnet.json", R"({"services": {"xgt-cnet": {}}})"),
      two = folder.write("two.json", R"({"protocol": ["xgt-fenet", "modbus-tcp"]})"),
      partner = folder.write(
          "partner.json",
          R"({"p2p": {"partner": "127.0.0.300", "blocks": [{"flag": "F92", "read": "%MW1", "save": "%MW2"}]}})");
  const auto emulate = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"emulate", "xbc-h?protocol=xgt-fenet"});
    const Finished finished = run_tool(arguments);
    EXPECT_EQ(finished.code, 2) << finished.out;
    return finished.err;
  };
  EXPECT_THAT(emulate({"--tcp", ":0", "--config", cnet}), HasSubstr("give --pty or --tty as well"));
  EXPECT_THAT(emulate({"--tcp", ":0", "--pty", folder / "plc"}),
              HasSubstr("no serial line beside its network"));
  EXPECT_THAT(
      emulate({"--tcp", ":0", "--config", two}),
      AllOf(HasSubstr("two.json"), HasSubstr("protocol is [\"xgt-fenet\",\"modbus-tcp\"]")));
  EXPECT_THAT(emulate({"--p2p", partner}), HasSubstr("partner is \"127.0.0.300\""));
  const Finished serial = run_tool({"emulate", "xbc-h", "--tcp", ":0", "--pty", folder / "plc"});
  EXPECT_EQ(serial.code, 2);
  EXPECT_THAT(serial.err, HasSubstr("is on one serial line"));
}

TEST(XgtFenetEmulated, prints_each_frame_and_says_which_port_is_wrong) {
  Fenet device({"-v"});
  const Finished run = run_tool({"run", "--endpoint", device.endpoint(), "--profile", "xbc-h",
                                 "--filter", "xgt_fenet/examples/read_word", "--allow-write",
                                 "all,P,Q,U", "--out", TestFolder() / "out"});
  EXPECT_EQ(run.code, 0) << run.out << run.err;
  EXPECT_TRUE(device.process().wait_for("4C 53 49 53 2D 58 47 54 00 00 00 00 A0 33 00 00 0E 00"));
  device.process().signal(SIGINT);
  EXPECT_EQ(device.process().wait().code, 0);
}

TEST(XgtFenetEmulated, a_port_for_root_names_another) {
  std::ifstream limit("/proc/sys/net/ipv4/ip_unprivileged_port_start");
  if (int first = 0; !(limit >> first) || first <= 502)
    GTEST_SKIP() << "here every port is for everybody";
  std::vector<std::string> command =
      tool_arguments({"emulate", "xbc-h?protocol=modbus-tcp", "--tcp", "127.0.0.1:502"});
  if (::geteuid() == 0)
    command.insert(command.begin(), {"setpriv", "--bounding-set=-net_bind_service",
                                     "--inh-caps=-net_bind_service", "--"});
  const Finished finished = run_program(command);
  EXPECT_EQ(finished.code, 3) << finished.out;
  EXPECT_THAT(finished.err,
              HasSubstr("ports below 1024 are for root; choose one from 1024 up, such "
                        "as 127.0.0.1:10502, or run it as root"));
}

TEST(XgtFenetReadme, a_client_of_four_lines_reads_a_word) {
  Fenet device;
  const os::UniqueFd writer = os::test::connected(SOCK_STREAM, device.port());
  const std::string write =
      to_text(*from_hex("4C 53 49 53 2D 58 47 54 00 00 00 00 A0 33 01 00 14 00 00 00 58 00 02 00 "
                        "00 00 01 00 06 00 25 "
                        "4D 57 31 30 30 02 00 34 12"));
  os::test::say(writer, write);
  EXPECT_EQ(os::test::hear(writer).size(), 30u);
  const Finished client = run_program({"python3", "-c", client_of_the_readme(device.port())});
  EXPECT_EQ(client.out, "4660\n") << client.err;
}

/// A program that is asked by connections alone is not to blame for datagrams.
TEST(XgtFenetBench, WithoutAPortForDatagramsTheirCasesAreBlocked) {
  const TestFolder folder;
  const Finished finished =
      run_tool({"run", "--endpoint",
                std::string("exec:") + FIELDPROOF_TOOL +
                    " emulate 'xbc-h?protocol=xgt-fenet' --tcp 127.0.0.1:{port}?protocol=xgt-fenet",
                "--profile", "xbc-h", "--filter", "xgt_fenet/udp/read/*:xgt_fenet/examples/*",
                "--out", folder.path()});
  EXPECT_EQ(finished.code, 0) << finished.out << finished.err;
  Results results = read_results(folder / "results.ndjson");
  EXPECT_EQ(results.counts()["FAIL"], 0u);
  EXPECT_GT(results.counts()["PASS"], 0u);
  EXPECT_GT(results.counts()["BLOCKED"], 0u);
  for (const auto& one : results.cases)
    if (one.at("id").get<std::string>().starts_with("xgt_fenet/udp/")) {
      EXPECT_EQ(one.at("verdict"), "BLOCKED");
      EXPECT_THAT(one.value("message", ""), HasSubstr("{udp_port}"));
    }
}

}  // namespace
}  // namespace fieldproof::tool_tests::fenet
