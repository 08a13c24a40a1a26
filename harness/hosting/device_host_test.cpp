#include "harness/hosting/device_host.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/socket.h>
#include <termios.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <future>
#include <thread>

#include "harness/endpoints/tcp.hpp"
#include "harness/endpoints/test_endpoint_name.hpp"
#include "harness/hosting/test_tiny_device.hpp"
#include "harness/system/fd_link.hpp"
#include "harness/system/interrupt.hpp"
#include "harness/system/pty_pair.hpp"
#include "harness/system/sockets/test_sockets.hpp"
#include "harness/test_protocol.hpp"

namespace fieldproof::hosting {

using os::FdLink;

namespace {

using endpoints::test::endpoint_name;
using os::test::connected;
using os::test::hear;
using os::test::receive_text;
using os::test::say;
using testing::HasSubstr;

namespace fs = std::filesystem;

/// A host in a thread; the end of the control socket ends it.
class Hosted {
 public:
  explicit Hosted(HostOptions options) {
    int ends[2];
    EXPECT_EQ(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends), 0);
    control_.emplace(os::UniqueFd(ends[0]), "control");
    options.control = ends[1];
    if (!options.make_device) options.make_device = hosting::test::make_tiny_device;
    if (options.model.empty()) options.model = "tiny";
    options.say = [this](std::string_view line) { said_.set_value(std::string(line)); };
    thread_ = std::thread([this, options] { code_ = host_device(options); });
    where = said_.get_future().get();
  }
  ~Hosted() { end(); }
  int end() {
    control_.reset();
    if (thread_.joinable()) thread_.join();
    return code_;
  }
  int wait() {
    thread_.join();
    return code_;
  }
  std::string ask(const std::string& line) {
    EXPECT_TRUE(control_->send(to_bytes(line + '\n')));
    return receive_text(*control_, "\n");
  }
  std::string where;

 private:
  std::optional<FdLink> control_;
  std::promise<std::string> said_;
  std::thread thread_;
  int code_ = -1;
};

FdLink open_client(const std::string& path) {
  os::UniqueFd fd(::open(path.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC));
  EXPECT_TRUE(fd) << path;
  return FdLink(std::move(fd), path);
}

std::string new_path(const std::string& name) {
  const std::string path =
      testing::TempDir() + "/fieldproof_" + name + '_' + std::to_string(::getpid());
  fs::remove(path);
  return path;
}

TEST(DeviceHost, MakesAPtyAndSaysItsPath) {
  Hosted host({});
  ASSERT_THAT(host.where, testing::StartsWith("pty /dev/pts/"));
  FdLink client = open_client(host.where.substr(4));
  ASSERT_TRUE(client.send(to_bytes("hello.")));
  EXPECT_EQ(receive_text(client, ">"), "<hello>");
  EXPECT_EQ(host.end(), 0);
}

TEST(DeviceHost, ANewPathBecomesALinkUntilTheEnd) {
  HostOptions options;
  options.pty = new_path("link");
  fs::create_symlink("/dev/pts/no_such", options.pty);  // left by a host that was killed
  Hosted host(options);
  EXPECT_THAT(host.where, HasSubstr("linked from " + options.pty));
  {
    FdLink client = open_client(options.pty);
    ASSERT_TRUE(client.send(to_bytes("one.")));
    EXPECT_EQ(receive_text(client, ">"), "<one>");
  }
  FdLink again = open_client(options.pty);
  ASSERT_TRUE(again.send(to_bytes("two.")));
  EXPECT_EQ(receive_text(again, ">"), "<two>");
  EXPECT_EQ(host.end(), 0);
  EXPECT_FALSE(fs::is_symlink(options.pty));
}

TEST(DeviceHost, AFileIsRefusedAndKept) {
  HostOptions options;
  options.make_device = hosting::test::make_tiny_device;
  options.pty = new_path("file");
  std::ofstream(options.pty) << "precious";
  EXPECT_EQ(host_on_tty(options), 3);
  EXPECT_TRUE(fs::is_regular_file(options.pty));
  fs::remove(options.pty);
}

TEST(DeviceHost, ATerminalIsOpenedRaw) {
  Result<os::PtyPair> pty = os::open_pty_pair();
  ASSERT_TRUE(pty);
  termios cooked{};
  ASSERT_EQ(::tcgetattr(pty->slave.get(), &cooked), 0);
  cooked.c_lflag |= ECHO | ICANON;
  ASSERT_EQ(::tcsetattr(pty->slave.get(), TCSANOW, &cooked), 0);
  HostOptions options;
  options.tty = pty->path;
  Hosted host(options);
  FdLink bench(std::move(pty->master), "bench");
  ASSERT_TRUE(bench.send(to_bytes("raw\x04.")));
  EXPECT_EQ(receive_text(bench, ">"), "<raw\x04>");
  EXPECT_EQ(host.end(), 0);
}

TEST(DeviceHost, AVanishedTerminalIsTrouble) {
  Result<os::PtyPair> pty = os::open_pty_pair();
  ASSERT_TRUE(pty);
  HostOptions options;
  options.tty = pty->path;
  Hosted host(options);
  pty->slave.reset();
  pty->master.reset();
  EXPECT_EQ(host.wait(), 3);
}

TEST(DeviceHost, ADeviceThatCannotBeMadeIsAUsageError) {
  HostOptions options;
  options.make_device = hosting::test::make_tiny_device;
  options.model = "xgk";
  EXPECT_EQ(host_on_tty(options), 2);
}

TEST(DeviceHost, ServesTheControlSocket) {
  HostOptions options;
  options.config = {{"station", 7}, {"delay_ms", 0}};
  Hosted host(options);
  EXPECT_EQ(host.ask(R"({"set":{"%MW1":"12"}})"), "{\"ok\":true}\n");
  EXPECT_EQ(host.ask(R"({"get":{"%MW1":2}})"), "{\"values\":{\"%MW1\":\"12\"}}\n");
  EXPECT_EQ(host.ask(R"({"begin":{"delay_ms":1}})"), "{\"ok\":true}\n");
  EXPECT_THAT(host.ask(R"({"get":{"%MW1":2}})"), HasSubstr("nothing was set"))
      << "the device is fresh";
  const auto answer = nlohmann::json::parse(host.ask(R"({"get":["@config"]})"));
  EXPECT_EQ(
      nlohmann::json::parse(answer["values"]["@config"].get<std::string>()),
      nlohmann::json(
          {{"model", "tiny"}, {"station", 7}, {"delay_ms", 1}, {"inter_character_floor_ms", 20}}));
}

TEST(DeviceHost, TheStationIsOneUnlessGiven) {
  Hosted host({});
  EXPECT_THAT(host.ask(R"({"get":["@config"]})"), HasSubstr(R"(\"station\":1)"));
}

TEST(DeviceHost, RepliesWhenTheDeviceIsDue) {
  HostOptions options;
  options.config = {{"delay_ms", 30}};
  Hosted host(options);
  FdLink client = open_client(host.where.substr(4));
  const Result<Sent> sent = client.send(to_bytes("later."));
  ASSERT_TRUE(sent);
  EXPECT_EQ(receive_text(client, ">"), "<later>");
  EXPECT_GE(client.now() - sent->start, 30ms);
}

TEST(DeviceHost, AGapEndsAFrame) {
  Hosted host({});
  FdLink client = open_client(host.where.substr(4));
  ASSERT_TRUE(client.send(to_bytes("lost")));
  ASSERT_TRUE(client.receive(client.now() + 100ms));  // five times the gap
  ASSERT_TRUE(client.send(to_bytes("kept.")));
  EXPECT_EQ(receive_text(client, ">"), "<kept>");
  EXPECT_THAT(host.ask(R"({"get":["@dropped"]})"), HasSubstr("\"1\""));
}

TEST(DeviceHost, HangupIsAPowerCycle) {
  Hosted host({});
  host.ask(R"({"set":{"%MW1":"12"}})");
  ASSERT_EQ(::kill(::getpid(), SIGHUP), 0);
  EXPECT_THAT(host.ask(R"({"get":["%MW1"]})"), HasSubstr("nothing was set"));
}

TEST(DeviceHost, AnInterruptEndsItWell) {
  Hosted host({});
  os::interrupt();
  EXPECT_EQ(host.wait(), 0);
  os::clear_interrupt();
}

TEST(DeviceHost, ServesSocketsOneAfterAnotherAndTogether) {
  HostOptions options;
  options.tcp = "127.0.0.1:0";
  Hosted host(options);
  ASSERT_THAT(host.where, testing::StartsWith("tcp 127.0.0.1:"));
  const endpoints::EndpointName name = endpoint_name("tcp", host.where.substr(4));
  {
    auto first = endpoints::open_tcp(name, harness::TestProtocol());
    ASSERT_TRUE(first) << first.error().message;
    ASSERT_TRUE((*first)->send(to_bytes("first.")));
    EXPECT_EQ(receive_text(**first, ">"), "<first>");
  }
  auto one = endpoints::open_tcp(name, harness::TestProtocol());
  auto two = endpoints::open_tcp(name, harness::TestProtocol());
  ASSERT_TRUE(one && two);
  for (const auto& client : {one->get(), two->get(), one->get()}) {
    ASSERT_TRUE(client->send(to_bytes("in turn.")));
    EXPECT_EQ(receive_text(*client, ">"), "<in turn>");
  }
  const Result<Burst> nothing = (*two)->receive(Time{0});
  ASSERT_TRUE(nothing);
  EXPECT_TRUE(nothing->bytes.empty()) << "a reply went to another client";
}

/// An EchoDevice on a port of loopback, and what its monitor shows.
struct HostedNetwork {
  HostedNetwork() {
    HostOptions options;
    options.make_device = hosting::test::make_echo_device;
    options.model = "echo";
    options.tcp = options.udp = ":0";
    options.port = options.udp_port = 7;
    options.monitor = [this](const Traffic& traffic) {
      shown.push_back(monitor_line(traffic).substr(17));
    };
    host.emplace(options);
  }
  std::uint16_t port(const std::string& transport) const {
    const std::size_t at = host->where.find(transport + " 127.0.0.1:");
    EXPECT_NE(at, std::string::npos) << host->where;
    return static_cast<std::uint16_t>(std::stoi(host->where.substr(at + transport.size() + 11)));
  }
  std::vector<std::string> shown;
  std::optional<Hosted> host;
};

TEST(DeviceHost, EachConnectionToANetworkDeviceIsALink) {
  HostedNetwork network;
  const os::UniqueFd one = connected(SOCK_STREAM, network.port("tcp"));
  const os::UniqueFd two = connected(SOCK_STREAM, network.port("tcp"));
  say(one, "one");
  EXPECT_EQ(hear(one), "one");
  say(two, "two");
  EXPECT_EQ(hear(two), "two") << "not to whoever spoke last";
  say(one, "rst");
  EXPECT_EQ(hear(one), "ECONNRESET");
  say(two, "bye");
  EXPECT_EQ(hear(two), "FIN");
  say(two, "half");
  EXPECT_EQ(hear(two), "FIN");
  network.host->end();
  const std::string first = "#1 127.0.0.1:" + std::to_string(os::test::port_of(one));
  EXPECT_THAT(network.shown, testing::IsSupersetOf({first + "  connected",
                                                    first + "  received     3  6F 6E 65  one",
                                                    first + "  sent         3  6F 6E 65  one",
                                                    first + "  reset by the device (RST)"}));
  EXPECT_THAT(network.shown, testing::Contains(testing::MatchesRegex(
                                 "#2 127.0.0.1:[0-9]+  closed by the device \\(FIN\\)")));
}

TEST(DeviceHost, DatagramsAreAnsweredToTheirSender) {
  HostedNetwork network;
  const os::UniqueFd one = connected(SOCK_DGRAM, network.port("udp"));
  const os::UniqueFd two = connected(SOCK_DGRAM, network.port("udp"));
  say(one, "one");
  say(two, "two");
  EXPECT_EQ(hear(one), "one");
  EXPECT_EQ(hear(two), "two");
}

TEST(DeviceHost, ASocketThatTheDeviceDoesNotServeIsAUsageError) {
  HostOptions options;
  options.make_device = hosting::test::make_echo_device;
  options.model = "echo";
  options.port = options.udp_port = 9;
  options.tcp = ":0";
  EXPECT_EQ(host_on_socket(options), 2);
  options.tcp.clear();
  options.udp = ":0";
  EXPECT_EQ(host_on_socket(options), 2);
}

TEST(DeviceHost, ADeviceWithoutThatWayIsAUsageError) {
  HostOptions options;
  options.make_device = hosting::test::make_echo_device;
  EXPECT_EQ(host_on_tty(options), 2) << "it has no line";
  options.make_device = hosting::test::make_tiny_device;
  options.model = "tiny";
  options.tcp = ":0";
  options.port = options.udp_port = 7;
  EXPECT_EQ(host_on_socket(options), 2) << "it has no network";
}

TEST(DeviceHost, APortInUseIsTrouble) {
  const os::UniqueFd taken = os::test::bound(SOCK_STREAM);
  HostOptions options;
  options.make_device = hosting::test::make_echo_device;
  options.tcp = ":" + std::to_string(os::test::port_of(taken));
  options.port = options.udp_port = 7;
  EXPECT_EQ(host_on_socket(options), 3);
}

TEST(DeviceHost, ShowsTheTraffic) {
  std::vector<std::string> lines;
  HostOptions options;
  options.monitor = [&](const Traffic& traffic) {
    lines.push_back(monitor_line(traffic).substr(17));
  };
  Hosted host(options);
  FdLink client = open_client(host.where.substr(4));
  ASSERT_TRUE(client.send(to_bytes("\x05.")));
  EXPECT_EQ(receive_text(client, ">"), "<\x05>");
  host.end();
  EXPECT_THAT(lines,
              testing::ElementsAre("received     2  05 2E  ..", "sent         3  3C 05 3E  <.>"));
}

TEST(DeviceHost, AMonitorLineHasTimeDirectionSizeHexAndText) {
  const Bytes bytes = to_bytes(
      "\x05"
      "01rSS");
  EXPECT_EQ(monitor_line({12'345'600ns, true, bytes}),
            "      12.346 ms  received     6  05 30 31 72 53 53  .01rSS");
  EXPECT_EQ(monitor_line({12'345'600ns, false, bytes, LinkEvent::data, "#own 1", false}),
            "      12.346 ms  #own 1  waiting      6  05 30 31 72 53 53  .01rSS");
  EXPECT_EQ(monitor_line({0ns, true, {}, LinkEvent::reset, "#own 1", false}),
            "       0.000 ms  #own 1  refused, or out of reach: nothing was sent");
}

}  // namespace
}  // namespace fieldproof::hosting
