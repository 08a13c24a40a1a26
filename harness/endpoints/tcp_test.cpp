#include "harness/endpoints/tcp.hpp"

#include <gmock/gmock.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <nlohmann/json.hpp>

#include "harness/endpoints/test_endpoint_name.hpp"
#include "harness/system/fd_link.hpp"
#include "harness/system/interrupt.hpp"
#include "harness/system/sockets/socket_address.hpp"
#include "harness/test_protocol.hpp"

namespace fieldproof::endpoints {

using os::FdLink;

namespace {

using endpoints::test::endpoint_name;
using os::test::receive_text;
using testing::HasSubstr;

class Tcp : public testing::Test {
 protected:
  void SetUp() override {
    listener.reset(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    ASSERT_EQ(::bind(listener.get(), reinterpret_cast<sockaddr*>(&address), size), 0);
    ASSERT_EQ(::listen(listener.get(), 4), 0);
    ASSERT_EQ(::getsockname(listener.get(), reinterpret_cast<sockaddr*>(&address), &size), 0);
    where = "127.0.0.1:" + std::to_string(ntohs(address.sin_port));
  }
  FdLink accept() {
    return FdLink(os::UniqueFd(::accept4(listener.get(), nullptr, nullptr, SOCK_CLOEXEC)),
                  "device");
  }
  os::UniqueFd listener;
  std::string where;
};

TEST_F(Tcp, CarriesBytesBothWays) {
  auto endpoint = open_tcp(endpoint_name("tcp", where, {{"station", "1"}, {"floor_ms", "5"}}),
                           harness::TestProtocol());
  ASSERT_TRUE(endpoint) << endpoint.error().message;
  EXPECT_EQ((*endpoint)->describe(), "tcp:" + where);
  EXPECT_TRUE((*endpoint)->capabilities().real_device);
  EXPECT_EQ((*endpoint)->capabilities().timing_floor, 5ms);
  FdLink device = accept();
  ASSERT_TRUE((*endpoint)->send(to_bytes("question")));
  EXPECT_EQ(receive_text(device, "question"), "question");
  ASSERT_TRUE(device.send(to_bytes("answer")));
  EXPECT_EQ(receive_text(**endpoint, "answer"), "answer");
}

TEST_F(Tcp, AClosedConnectionIsAnErrorUntilTheNextCase) {
  auto endpoint = open_tcp(endpoint_name("tcp", where), harness::TestProtocol());
  ASSERT_TRUE(endpoint);
  { FdLink device = accept(); }
  EXPECT_THAT(os::test::receive_error(**endpoint).message,
              HasSubstr("the far end closed the connection"));
  ASSERT_TRUE((*endpoint)->begin(nlohmann::json::object()));
  EXPECT_EQ((*endpoint)->line_errors(), "1 lost connection") << "not opened again in silence";
  EXPECT_EQ((*endpoint)->line_errors(), "");
  FdLink device = accept();
  ASSERT_TRUE((*endpoint)->send(to_bytes("again")));
  EXPECT_EQ(receive_text(device, "again"), "again");
  device = FdLink(os::UniqueFd(), "none");
  listener.reset();
  EXPECT_THAT(os::test::receive_error(**endpoint).message, HasSubstr("the far end closed"));
  const Status begun = (*endpoint)->begin(nlohmann::json::object());
  ASSERT_FALSE(begun);
  EXPECT_THAT(begun.error().message, HasSubstr("nothing listens there"));
}

TEST_F(Tcp, SaysThatNothingListens) {
  listener.reset();
  const auto endpoint = open_tcp(endpoint_name("tcp", where), harness::TestProtocol());
  ASSERT_FALSE(endpoint);
  EXPECT_EQ(endpoint.error().message,
            "cannot connect to " + where +
                ": nothing listens there; start the device or serial server, or correct the port");
}

TEST_F(Tcp, RefusesWhatIsNoAddress) {
  const auto message = [](const std::string& target) {
    return open_tcp(endpoint_name("tcp", target), harness::TestProtocol()).error().message;
  };
  EXPECT_EQ(message("plc"), "cannot connect to plc: there is no port; write HOST:PORT");
  EXPECT_EQ(message("plc:"), "cannot connect to plc:: there is no port; write HOST:PORT");
  EXPECT_EQ(message(":2004"), "cannot connect to :2004: there is no host; write HOST:PORT");
  EXPECT_THAT(message("127.0.0.1:http"), HasSubstr("'http' is no port"));
  EXPECT_THAT(message("127.0.0.1:65536"), HasSubstr("'65536' is no port"));
}

TEST_F(Tcp, AnInterruptEndsConnecting) {
  os::interrupt();
  const auto endpoint = open_tcp(endpoint_name("tcp", where), harness::TestProtocol());
  os::clear_interrupt();
  ASSERT_FALSE(endpoint);
  EXPECT_TRUE(endpoint.error().interrupted);
}

class Udp : public testing::Test {
 protected:
  void SetUp() override {
    device.reset(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    ASSERT_EQ(::bind(device.get(), reinterpret_cast<sockaddr*>(&address), size), 0);
    ASSERT_EQ(::getsockname(device.get(), reinterpret_cast<sockaddr*>(&address), &size), 0);
    where = "127.0.0.1:" + std::to_string(ntohs(address.sin_port));
  }
  /// Waits for one datagram; answers go to its sender.
  std::string hear() {
    std::string text(4096, ' ');
    socklen_t size = sizeof client;
    const ssize_t n = ::recvfrom(device.get(), text.data(), text.size(), 0,
                                 reinterpret_cast<sockaddr*>(&client), &size);
    return n < 0 ? "!" : text.substr(0, static_cast<std::size_t>(n));
  }
  void say(const std::string& text) {
    ASSERT_EQ(::sendto(device.get(), text.data(), text.size(), 0,
                       reinterpret_cast<sockaddr*>(&client), sizeof client),
              static_cast<ssize_t>(text.size()));
  }
  os::UniqueFd device;
  sockaddr_in client{};
  std::string where;
};

TEST_F(Udp, OneSendIsOneDatagramAndOneBurstIsOne) {
  auto endpoint = open_udp(endpoint_name("udp", where), harness::TestProtocol());
  ASSERT_TRUE(endpoint) << endpoint.error().message;
  EXPECT_EQ((*endpoint)->describe(), "udp:" + where);
  EXPECT_FALSE((*endpoint)->capabilities().datagrams) << "it is one line";
  ASSERT_TRUE((*endpoint)->send(to_bytes("one")));
  ASSERT_TRUE((*endpoint)->send(to_bytes("two")));
  EXPECT_EQ(hear(), "one");
  EXPECT_EQ(hear(), "two");
  say("first");
  say("second");
  for (const char* expected : {"first", "second"}) {
    const Result<Burst> burst = (*endpoint)->receive((*endpoint)->now() + 5s);
    ASSERT_TRUE(burst) << burst.error().message;
    EXPECT_EQ(to_text(burst->bytes), expected);
  }
}

TEST_F(Udp, ADeviceThatIsGoneIsSaidAndMayComeBack) {
  auto endpoint = open_udp(endpoint_name("udp", where), harness::TestProtocol());
  ASSERT_TRUE(endpoint);
  sockaddr_in address{};
  socklen_t size = sizeof address;
  ASSERT_EQ(::getsockname(device.get(), reinterpret_cast<sockaddr*>(&address), &size), 0);
  device.reset();
  ASSERT_TRUE((*endpoint)->send(to_bytes("anybody?")));
  EXPECT_THAT(os::test::receive_error(**endpoint).message,
              HasSubstr("cannot receive from udp:" + where +
                        ": the connection broke (connection refused)"));
  device.reset(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  ASSERT_EQ(::bind(device.get(), reinterpret_cast<sockaddr*>(&address), size), 0);
  ASSERT_TRUE((*endpoint)->begin(nlohmann::json::object()));
  ASSERT_TRUE((*endpoint)->send(to_bytes("again")));
  EXPECT_EQ(hear(), "again");
}

TEST_F(Tcp, BracketsHoldAnAddressOfIpv6) {
  const Result<os::AddressInfo> list = os::resolve("[::1]:502", false);
  ASSERT_TRUE(list) << list.error().message;
  EXPECT_EQ((*list)->ai_family, AF_INET6);
}

}  // namespace
}  // namespace fieldproof::endpoints
