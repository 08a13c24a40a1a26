#include <gmock/gmock.h>
#include <poll.h>
#include <sys/socket.h>

#include <array>

#include "harness/hosting/host_port.hpp"
#include "harness/hosting/listening.hpp"
#include "harness/system/sockets/test_sockets.hpp"

namespace fieldproof::hosting {
namespace {

using os::test::connected;
using os::test::hear;
using os::test::say;
using testing::HasSubstr;

std::uint16_t port_behind(const std::string& description, const std::string& transport) {
  const std::size_t at = description.find(transport + " 127.0.0.1:");
  EXPECT_NE(at, std::string::npos) << description;
  return static_cast<std::uint16_t>(std::stoi(description.substr(at + transport.size() + 11)));
}

class NetworkPortTest : public testing::Test {
 protected:
  /// What comes next, waited for.
  Burst next() {
    for (;;) {
      Result<std::optional<Burst>> burst = port->read();
      EXPECT_TRUE(burst);
      if (*burst) return **burst;
      std::vector<pollfd> fds;
      port->add_to(fds);
      if (::poll(fds.data(), fds.size(), 5000) <= 0) return Burst{.bytes = {}, .peer = "time-out"};
      port->heard(fds);
    }
  }
  std::unique_ptr<HostPort> port = std::move(*open_network_port({":0", ":0", 502, 502}));
  std::uint16_t tcp = port_behind(port->describe(), "tcp");
  std::uint16_t udp = port_behind(port->describe(), "udp");
};

TEST_F(NetworkPortTest, ConnectionsAreLinksToThePortOfTheDevice) {
  const os::UniqueFd one = connected(SOCK_STREAM, tcp), two = connected(SOCK_STREAM, tcp);
  const Burst first = next(), second = next();
  EXPECT_EQ(first.event, LinkEvent::opened);
  EXPECT_EQ(first.port, 502);
  EXPECT_EQ(first.peer, "127.0.0.1:" + std::to_string(os::test::port_of(one)));
  EXPECT_NE(first.link, second.link);
  say(two, "question");
  EXPECT_EQ(to_text(next().bytes), "question");
  port->write({.bytes = to_bytes("to two"), .link = second.link});
  port->write({.bytes = to_bytes("to one"), .link = first.link});
  EXPECT_EQ(hear(one), "to one");
  EXPECT_EQ(hear(two), "to two");
}

TEST_F(NetworkPortTest, TheDeviceEndsLinksByFinOrRst) {
  const os::UniqueFd one = connected(SOCK_STREAM, tcp), two = connected(SOCK_STREAM, tcp);
  const LinkId first = next().link, second = next().link;
  port->write({.bytes = to_bytes("last"), .link = first});
  port->write({.bytes = {}, .link = first, .event = LinkEvent::closed});
  port->write({.bytes = {}, .link = second, .event = LinkEvent::reset});
  EXPECT_EQ(hear(one), "last");
  EXPECT_EQ(hear(one), "FIN");
  EXPECT_EQ(hear(two), "ECONNRESET");
  say(one, "half closed");
  EXPECT_EQ(to_text(next().bytes), "half closed");
  port->write({.bytes = to_bytes("lost"), .link = second});
}

TEST_F(NetworkPortTest, DatagramsAreAnsweredToTheirSender) {
  const os::UniqueFd one = connected(SOCK_DGRAM, udp), two = connected(SOCK_DGRAM, udp);
  say(one, "");
  const Burst first = next();
  EXPECT_EQ(first.event, LinkEvent::datagram);
  EXPECT_EQ(first.port, 502);
  EXPECT_TRUE(first.bytes.empty());
  say(two, "b");
  const Burst second = next();
  port->write({.bytes = to_bytes("B"), .link = second.link, .event = LinkEvent::datagram});
  port->write({.bytes = to_bytes("A"), .link = first.link, .event = LinkEvent::datagram});
  EXPECT_EQ(hear(one), "A");
  EXPECT_EQ(hear(two), "B");
}

TEST_F(NetworkPortTest, TheDeviceConnectsToOthers) {
  const os::UniqueFd partner = os::test::bound(SOCK_STREAM);
  const LinkId link = first_own_link + 3;
  port->write({.bytes = {},
               .link = link,
               .event = LinkEvent::opened,
               .port = os::test::port_of(partner),
               .peer = "127.0.0.1"});
  port->write({.bytes = to_bytes("request"), .link = link});
  const os::UniqueFd accepted = os::test::accepted(partner);
  ASSERT_TRUE(port->read());  // sends what could not go out before the connection stood
  EXPECT_EQ(hear(accepted), "request");
  say(accepted, "reply");
  const Burst reply = next();
  EXPECT_EQ(reply.link, link);
  EXPECT_EQ(to_text(reply.bytes), "reply");
}

TEST_F(NetworkPortTest, APartnerThatRefusesIsAReset) {
  os::UniqueFd partner = os::test::bound(SOCK_STREAM);
  const std::uint16_t nobody = os::test::port_of(partner);
  partner.reset();
  port->write({.bytes = {},
               .link = first_own_link,
               .event = LinkEvent::opened,
               .port = nobody,
               .peer = "127.0.0.1"});
  const Burst refused = next();
  EXPECT_EQ(refused.link, first_own_link);
  EXPECT_EQ(refused.event, LinkEvent::reset);
}

TEST_F(NetworkPortTest, AClientThatAsksOnWithoutReadingLosesNoAnswer) {
  const os::UniqueFd client = connected(SOCK_STREAM, tcp);
  next();
  const std::string questions(10'000, '?'), answer(20, '!');  // one to each character
  std::size_t sent = 0, heard = 0;
  const auto serve = [&] {
    std::vector<pollfd> fds;
    port->add_to(fds);
    if (::poll(fds.data(), fds.size(), 50) > 0) port->heard(fds);
    const Result<std::optional<Burst>> burst = port->read();
    if (!burst || !*burst) return false;
    EXPECT_EQ((*burst)->event, LinkEvent::data);
    std::string answers;
    for (std::size_t i = 0; i < (*burst)->bytes.size(); ++i) answers += answer;
    port->write({.bytes = to_bytes(answers), .link = (*burst)->link});
    return (*burst)->event == LinkEvent::data;
  };
  for (bool goes_on = true; goes_on;) {
    const ssize_t n =
        ::send(client.get(), questions.data(), questions.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
    if (n > 0) sent += static_cast<std::size_t>(n);
    goes_on = n > 0 || serve();
  }
  std::array<char, 1 << 16> buffer;
  const auto hear_all = [&] {
    const std::size_t before = heard;
    for (ssize_t n = 1; n > 0;) {
      n = ::recv(client.get(), buffer.data(), buffer.size(), MSG_DONTWAIT);
      if (n > 0) heard += static_cast<std::size_t>(n);
    }
    return heard > before;
  };
  for (bool goes_on = true; goes_on;) goes_on = hear_all() | serve();
  EXPECT_GT(sent, 100'000u);
  EXPECT_EQ(heard, sent * answer.size());
}

TEST_F(NetworkPortTest, TheDeviceSendsDatagramsOfItsOwn) {
  const os::UniqueFd partner = os::test::bound(SOCK_DGRAM);
  port->write({.bytes = to_bytes("report"),
               .link = first_own_link,
               .event = LinkEvent::datagram,
               .port = os::test::port_of(partner),
               .peer = "127.0.0.1"});
  EXPECT_EQ(hear(partner), "report");
}

TEST_F(NetworkPortTest, AFreshDeviceHasNoLinks) {
  const os::UniqueFd client = connected(SOCK_STREAM, tcp);
  next();
  port->flush();
  EXPECT_EQ(hear(client), "FIN");
  const os::UniqueFd again = connected(SOCK_STREAM, tcp);
  EXPECT_EQ(next().event, LinkEvent::opened);
}

TEST(HostListening, AddressesAreReadAndLoopbackIsMeantWhereNoneIsGiven) {
  const auto read = [](const std::string& text, std::optional<std::uint16_t> usual = 502) {
    const Result<os::SocketName> name = read_address(text, usual);
    return name ? to_string(*name) : name.error().message;
  };
  EXPECT_EQ(read(":2004"), "127.0.0.1:2004");
  EXPECT_EQ(read("2004"), "127.0.0.1:2004");
  EXPECT_EQ(read("0.0.0.0:2004"), "0.0.0.0:2004");
  EXPECT_EQ(read("192.168.1.10"), "192.168.1.10:502");
  EXPECT_EQ(read("192.168.1.10", std::nullopt),
            "cannot listen on 192.168.1.10: there is no port; write PORT or HOST:PORT");
  EXPECT_THAT(read("127.0.0.1:65536"), HasSubstr("'65536' is no port"));
}

TEST(HostListening, SaysWhyItCannot) {
  const os::UniqueFd taken = os::test::bound(SOCK_STREAM);
  const auto port =
      open_network_port({":" + std::to_string(os::test::port_of(taken)), "", 502, 502});
  ASSERT_FALSE(port);
  EXPECT_THAT(port.error().message,
              HasSubstr("the port is in use; end the program that has it, or choose another port"));
}

}  // namespace
}  // namespace fieldproof::hosting
