#include "harness/endpoints/rfc2217.hpp"

#include <gmock/gmock.h>
#include <termios.h>

#include <nlohmann/json.hpp>
#include <numeric>

#include "harness/endpoints/rfc2217_test_servers.hpp"
#include "harness/endpoints/serial.hpp"
#include "harness/endpoints/test_endpoint_name.hpp"
#include "harness/system/fd_link.hpp"
#include "harness/system/pty_pair.hpp"
#include "src/line/settings.hpp"

namespace fieldproof::endpoints::rfc2217_test {
namespace {

using endpoints::test::endpoint_name;
using os::test::receive_error;
using os::test::receive_text;
using test::FakeServer;
using test::FakeServerOptions;
using test::Ser2net;
using test::Ser2netOptions;
using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using Options = std::map<std::string, std::string>;

const nlohmann::json no_config = nlohmann::json::object();

Result<std::unique_ptr<Endpoint>> open(const std::string& where, const Options& options = {},
                                       Duration patience = 5s) {
  return open_rfc2217(endpoint_name("rfc2217", where, options), patience);
}

std::string refusal(const std::string& where, const Options& options = {}, Duration patience = 5s) {
  const auto endpoint = open(where, options, patience);
  return endpoint ? "opened" : endpoint.error().message;
}

std::string every_byte() {
  std::string text(256, '\0');
  std::iota(text.begin(), text.end(), '\0');
  return text + "\xFF\xFF\xFF";
}

/// A real ser2net in front of a pty, whose other end the test has.
class Rfc2217 : public testing::Test {
 protected:
  void SetUp() override {
    Result<os::PtyPair> pty = os::open_pty_pair();
    ASSERT_TRUE(pty) << pty.error().message;
    path = pty->path;
    slave = std::move(pty->slave);
    far.emplace(std::move(pty->master), "far end");
    server.emplace(path);
  }
  std::string path;
  os::UniqueFd slave;
  std::optional<os::FdLink> far;
  std::optional<Ser2net> server;
};

TEST_F(Rfc2217, CarriesEveryByteBothWays) {
  auto port = open(server->where(), {{"baud", "115200"}, {"floor_ms", "30"}});
  ASSERT_TRUE(port) << port.error().message;
  EXPECT_EQ((*port)->describe(), "rfc2217:" + server->where() + " 115200-8N1");
  EXPECT_TRUE((*port)->capabilities().real_device);
  EXPECT_FALSE((*port)->capabilities().wire);
  EXPECT_EQ((*port)->capabilities().timing_floor, 30ms);
  ASSERT_TRUE((*port)->send(to_bytes(every_byte())));
  EXPECT_EQ(receive_text(*far, every_byte()), every_byte());
  ASSERT_TRUE(far->send(to_bytes(every_byte())));
  EXPECT_EQ(receive_text(**port, every_byte()), every_byte());
  EXPECT_EQ((*port)->line_errors(), "");
}

TEST_F(Rfc2217, SetsSpeedAndFormatOfTheFarPort) {
  const auto port = open(server->where(), {{"baud", "57600"}, {"frame", "7O2"}});
  ASSERT_TRUE(port) << port.error().message;
  EXPECT_EQ((*port)->character_time(), (line::LineSettings{57600, 7, 'O', 2}.character_time()));
  termios settings{};
  ASSERT_EQ(::tcgetattr(slave.get(), &settings), 0);
  EXPECT_EQ(::cfgetospeed(&settings), static_cast<speed_t>(B57600));
  EXPECT_TRUE(settings.c_cflag & CSTOPB);
  EXPECT_TRUE(settings.c_cflag & PARODD) << "a pty keeps no parity, but that it was odd";
}

TEST_F(Rfc2217, WhatWaitedAtOpeningIsPurged) {
  ASSERT_TRUE(far->send(to_bytes("stale")));
  pollfd there{slave.get(), POLLIN, 0};
  ASSERT_EQ(::poll(&there, 1, 5000), 1);
  auto port = open(server->where());
  ASSERT_TRUE(port) << port.error().message;
  ASSERT_TRUE(far->send(to_bytes("fresh")));
  EXPECT_EQ(receive_text(**port, "fresh"), "fresh");
}

TEST_F(Rfc2217, ASecondUserIsToldWhatTheServerSays) {
  const auto first = open(server->where());
  ASSERT_TRUE(first) << first.error().message;
  EXPECT_THAT(refusal(server->where()),
              AllOf(HasSubstr("cannot open rfc2217:" + server->where() + ": the server says '"),
                    HasSubstr("already in use' and closes the connection; see who")));
}

TEST_F(Rfc2217, ThePortOfAServerIsInUseForOthers) {
  // ser2net locks no port of /dev/pts, so it gets a link.
  const std::string link = testing::TempDir() + "rfc2217_port_" + std::to_string(::getpid());
  std::filesystem::create_symlink(path, link);
  const Ser2net locking(link);
  const auto remote = open(locking.where());
  EXPECT_TRUE(remote) << remote.error().message;
  const auto local = open_serial(endpoint_name("serial", link));
  std::filesystem::remove(link);
  ASSERT_FALSE(local);
  EXPECT_THAT(local.error().message,
              AllOf(HasSubstr("the port is in use by process "), HasSubstr(" (ser2net) since 20")));
}

TEST_F(Rfc2217, AServerWithoutRfc2217IsSaid) {
  const Ser2net plain(path, {"telnet"});
  EXPECT_THAT(refusal(plain.where()),
              HasSubstr("cannot open rfc2217:" + plain.where() +
                        ": the server refuses RFC 2217 (COM-PORT-OPTION); in its "
                        "ser2net.yaml write `accepter: telnet(rfc2217),tcp,PORT`"));
}

TEST_F(Rfc2217, APortThatTheServerLacksIsSaid) {
  const Ser2net none("/dev/no_such_port");
  EXPECT_THAT(refusal(none.where()), HasSubstr("the server says 'Device open failure: Value or "
                                               "file not found' and closes the connection; see who "
                                               "uses the port, and the connector line"));
}

TEST_F(Rfc2217, AKilledServerIsTroubleUntilItIsBack) {
  auto port = open(server->where());
  ASSERT_TRUE(port) << port.error().message;
  const int number = server->port();
  server->kill();
  EXPECT_THAT(receive_error(**port).message,
              AllOf(HasSubstr("cannot receive from rfc2217:" + server->where()),
                    HasSubstr("see that the device or serial server still runs")));
  EXPECT_THAT((*port)->begin(no_config).error().message,
              HasSubstr("cannot connect to " + server->where() + ": nothing listens there"));
  server.emplace(path, Ser2netOptions{.port = number});
  const Status back = (*port)->begin(no_config);
  ASSERT_TRUE(back) << back.error().message;
  ASSERT_TRUE((*port)->send(to_bytes("again")));
  EXPECT_EQ(receive_text(*far, "again"), "again");
  EXPECT_EQ((*port)->line_errors(), "2 lost connections")
      << "a run must show that it was not one session";
  EXPECT_EQ((*port)->line_errors(), "");
}

TEST_F(Rfc2217, APtyHasNoRts) {
  EXPECT_THAT(refusal(server->where(), {{"rs485", "rts"}}, 300ms),
              HasSubstr("cannot set rfc2217:" + server->where() + " to RTS off"));
}

TEST(Rfc2217Options, TheDriversRs485ModeIsTheServers) {
  EXPECT_THAT(refusal("plc:2000", {{"rs485", "1"}}),
              AllOf(HasSubstr("RFC 2217 has no command for rs485=1; set it at the server"),
                    HasSubstr("rs485=0:0")));
  EXPECT_THAT(refusal("plc:2000", {{"frame", "9N1"}}), HasSubstr("cannot open rfc2217:plc:2000: "));
  EXPECT_THAT(refusal("plc"), HasSubstr("there is no port; write HOST:PORT"));
}

TEST(Rfc2217Server, IsToldEverythingInOrder) {
  FakeServer server;
  auto port = open(server.where(), {{"baud", "38400"}, {"frame", "8E2"}, {"rs485", "rts"}});
  ASSERT_TRUE(port) << port.error().message;
  ASSERT_TRUE((*port)->send({{0x05, 0xFF}}));
  EXPECT_THAT(server.heard(), ElementsAre("1 00 00 96 00", "2 08", "3 03", "4 02", "5 01", "5 0C",
                                          "10 1E", "12 03",  //
                                          "5 0B", "data 05 FF", "5 0C"));
}

TEST(Rfc2217Server, AnotherSpeedThanAskedForIsAnError) {
  FakeServer server({.only_baud = 9600});
  EXPECT_THAT(refusal(server.where(), {{"baud", "38400"}}),
              HasSubstr("cannot set rfc2217:" + server.where() +
                        " to 38400-8N1 (speed): the server answers 9600 to 38400; see that its "
                        "adapter offers it"));
  EXPECT_TRUE(open(server.where(), {{"baud", "9600"}}));
}

TEST(Rfc2217Server, ACommandThatIsNotConfirmedIsAnError) {
  for (const auto& [command, what] : std::map<Byte, std::string>{{1, "(speed)"},
                                                                 {2, "(data bits)"},
                                                                 {3, "(parity"},
                                                                 {4, "(stop bits)"},
                                                                 {5, "no flow control"},
                                                                 {12, "empty buffers"}}) {
    FakeServer server({.unconfirmed = {command}});
    EXPECT_THAT(
        refusal(server.where(), {}, 100ms),
        AllOf(HasSubstr(what),
              HasSubstr("the server does not confirm it within 0.1 s; see that its host is on")));
  }
  FakeServer server({.unconfirmed = {telnet::set_line_state_mask}});
  EXPECT_TRUE(open(server.where())) << "ser2net answers it in a way of its own";
}

TEST(Rfc2217Server, MustSpeakTelnet) {
  FakeServer mute({.speaks_telnet = false});
  EXPECT_THAT(refusal(mute.where(), {}, 100ms),
              HasSubstr("the server does not agree to RFC 2217 (COM-PORT-OPTION)"));
  FakeServer cooked({.has_binary = false});
  EXPECT_THAT(refusal(cooked.where()), HasSubstr("the server refuses binary transmission"));
}

TEST(Rfc2217Server, ItsGreetingIsNoData) {
  FakeServer server({.greeting = "Welcome\r\n"});
  auto port = open(server.where());
  ASSERT_TRUE(port) << port.error().message;
  ASSERT_TRUE((*port)->send(to_bytes("echo")));
  EXPECT_EQ(receive_text(**port, "echo"), "echo");
}

TEST(Rfc2217Server, WhatCameBeforeACaseIsNotPurged) {
  FakeServer server;
  auto port = open(server.where());
  ASSERT_TRUE(port) << port.error().message;
  const std::string text(100, 'x');  // 100 ms on the wire: the echo is there when it has been sent
  ASSERT_TRUE((*port)->send(to_bytes(text)));
  ASSERT_TRUE((*port)->begin(no_config));
  EXPECT_EQ(receive_text(**port, text), text);
  EXPECT_THAT(server.heard(), Contains("12 03").Times(1)) << "one purge, at opening";
}

TEST(Rfc2217Server, BehindNoWireARequestIsOverWhenItIsHandedOver) {
  FakeServer server;
  auto port = open(server.where());
  ASSERT_TRUE(port) << port.error().message;
  const std::string text(300, 'x');  // 312 ms on a wire: the echo begins while it is sent
  const auto gap = [&] {
    const Result<Sent> sent = (*port)->send(to_bytes(text));
    const Result<Burst> echo = (*port)->receive((*port)->now() + 10s);
    EXPECT_TRUE(sent && echo);
    const Duration took = echo->start - sent->end;
    receive_text(**port, text.substr(echo->bytes.size()));
    return took;
  };
  EXPECT_TRUE((*port)->capabilities().paced);
  EXPECT_LT(gap(), 0ns) << "as it came";
  (*port)->has_no_wire();
  EXPECT_FALSE((*port)->capabilities().paced);
  EXPECT_GE(gap(), 0ns);
}

TEST(Rfc2217Server, NotifiesLineErrors) {
  FakeServer server;
  auto port = open(server.where());
  ASSERT_TRUE(port) << port.error().message;
  server.notify_next(telnet::parity_error | telnet::break_detect);
  ASSERT_TRUE((*port)->send(to_bytes("1")));
  EXPECT_EQ(receive_text(**port, "1"), "1");
  server.notify_next(telnet::parity_error | telnet::framing_error | telnet::overrun_error);
  ASSERT_TRUE((*port)->send(to_bytes("2")));
  EXPECT_EQ(receive_text(**port, "2"), "2");
  server.notify_next(telnet::framing_error);
  ASSERT_TRUE((*port)->send(to_bytes("3")));
  EXPECT_EQ(receive_text(**port, "3"), "3");
  EXPECT_EQ((*port)->line_errors(), "2 parity errors, 2 framing errors, 1 break, 1 overrun");
  EXPECT_EQ((*port)->line_errors(), "");
}

TEST(Rfc2217Server, SilenceOfADeadServerIsNotTheDevices) {
  FakeServer server;
  auto port = open(server.where(), {}, 200ms);
  ASSERT_TRUE(port) << port.error().message;
  ASSERT_TRUE((*port)->send(to_bytes("x")));
  EXPECT_EQ(receive_text(**port, "x"), "x");
  const Result<Burst> quiet = (*port)->receive((*port)->now() + 1ms);
  ASSERT_TRUE(quiet) << "silence is believed while the server lives";
  EXPECT_TRUE(quiet->bytes.empty());
  server.play_dead();
  ASSERT_TRUE((*port)->send(to_bytes("y")));
  const Result<Burst> burst = (*port)->receive((*port)->now() + 1ms);
  ASSERT_FALSE(burst);
  EXPECT_EQ(burst.error().message,
            "cannot receive from rfc2217:" + server.where() +
                ": the server does not answer any more; see that its host and the network are up");
}

TEST(Rfc2217Server, ATransmissionLastsAsLongAsOnTheWire) {
  FakeServer server;
  auto port = open(server.where(), {{"baud", "9600"}});
  ASSERT_TRUE(port) << port.error().message;
  const Result<Sent> sent = (*port)->send(to_bytes("0123456789"));
  ASSERT_TRUE(sent);
  EXPECT_EQ(sent->end - sent->start, 10 * (*port)->character_time());
  EXPECT_GE((*port)->now(), sent->end);
}

}  // namespace
}  // namespace fieldproof::endpoints::rfc2217_test
