#include "harness/system/sockets/bench_sockets.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>

#include "harness/system/interrupt.hpp"
#include "harness/system/sockets/socket_connect.hpp"
#include "harness/system/sockets/socket_listen.hpp"
#include "harness/system/sockets/test_sockets.hpp"

namespace fieldproof::os {
namespace {

using test::accepted;
using test::bound;
using test::break_off;
using test::hear;
using test::say;
using testing::HasSubstr;

/// "1 data 'abc'", or "-" for nothing within `patience`.
std::string next(BenchSockets& bench, Duration patience = 5s) {
  const Result<Burst> burst = bench.receive(bench.now() + patience);
  if (!burst) return burst.error().message;
  const char* names[] = {"data", "datagram", "opened", "closed", "reset"};
  const auto event = static_cast<std::size_t>(burst->event);
  if (burst->link == line_link && burst->bytes.empty()) return "-";
  std::string text = std::to_string(burst->link % first_own_link) + ' ' + names[event];
  if (!burst->bytes.empty()) text += " '" + to_text(burst->bytes) + '\'';
  return text;
}

/// A bench with connections to one listening socket.
class BenchSocketsTest : public testing::Test {
 protected:
  /// A new link, and the device's end of it.
  LinkId open() {
    Result<UniqueFd> fd = host->connect(test::port_of(listener), SOCK_STREAM);
    EXPECT_TRUE(fd) << fd.error().message;
    const LinkId link = bench.add(Transport::tcp, std::move(*fd), test::port_of(listener));
    device.push_back(accepted(listener));
    return link;
  }
  UniqueFd listener = bound(SOCK_STREAM);
  Result<RemoteHost> host = RemoteHost::find("127.0.0.1");
  std::vector<UniqueFd> device;
  BenchSockets bench{"tcp:test"};
};

TEST_F(BenchSocketsTest, SeveralConnectionsAreLinksOfTheirOwn) {
  EXPECT_EQ(open(), 1u);
  EXPECT_EQ(open(), 2u);
  say(device[1], "to two");
  EXPECT_EQ(next(bench), "2 data 'to two'");
  say(device[0], "to one");
  EXPECT_EQ(next(bench), "1 data 'to one'");
  ASSERT_TRUE(bench.send(to_bytes("from two"), 2));
  EXPECT_EQ(hear(device[1]), "from two");
  EXPECT_EQ(next(bench, 0ns), "-");
}

TEST_F(BenchSocketsTest, FinAndRstAreToldApartAndComeBehindTheBytes) {
  open();
  open();
  say(device[0], "last");
  device[0].reset();
  EXPECT_EQ(next(bench), "1 data 'last'");
  EXPECT_EQ(next(bench), "1 closed");
  say(device[1], "last");
  break_off(device[1]);
  EXPECT_EQ(next(bench), "2 data 'last'");
  EXPECT_EQ(next(bench), "2 reset");
  EXPECT_EQ(next(bench, 0ns), "-");
}

TEST_F(BenchSocketsTest, AResetThatASendMeetsIsStillAReset) {
  open();
  break_off(device[0]);
  ASSERT_TRUE(bench.send(to_bytes("too late"), 1)) << "no trouble of the bench";
  ASSERT_TRUE(bench.send(to_bytes("much too late"), 1));
  EXPECT_EQ(next(bench), "1 reset");
  EXPECT_TRUE(bench.send(to_bytes("dropped"), 1));
}

TEST_F(BenchSocketsTest, AHalfClosedConnectionGoesOnHearing) {
  open();
  ASSERT_TRUE(bench.send(to_bytes("question"), 1));
  ASSERT_TRUE(bench.close(1, Closing::fin));
  EXPECT_EQ(hear(device[0]), "question");
  EXPECT_EQ(hear(device[0]), "FIN");
  say(device[0], "answer");
  EXPECT_EQ(next(bench), "1 data 'answer'");
  device[0].reset();
  EXPECT_EQ(next(bench), "1 closed");
  const Result<Sent> sent = bench.send(to_bytes("x"), 1);
  ASSERT_FALSE(sent);
  EXPECT_EQ(sent.error().message,
            "cannot send to tcp:test: the link is not open: it was closed on this side");
  EXPECT_FALSE(bench.close(1, Closing::fin));
}

TEST_F(BenchSocketsTest, ADeviceThatHasClosedMayBeSentTo) {
  open();
  ::shutdown(device[0].get(), SHUT_WR);
  EXPECT_EQ(next(bench), "1 closed");
  ASSERT_TRUE(bench.send(to_bytes("still heard"), 1));
  EXPECT_EQ(hear(device[0]), "still heard");
  device[0].reset();
  ASSERT_TRUE(bench.send(to_bytes("not any more"), 1));
  EXPECT_EQ(next(bench, 50ms), "-") << "the reset that answers it is no news";
}

TEST_F(BenchSocketsTest, AResetIsSeenAsOneByTheDevice) {
  open();
  ASSERT_TRUE(bench.close(1, Closing::rst));
  EXPECT_EQ(hear(device[0]), "ECONNRESET");
  EXPECT_EQ(next(bench, 0ns), "-");
}

TEST_F(BenchSocketsTest, AClientThatVanishesSaysNothing) {
  open();
  ASSERT_TRUE(bench.close(1, Closing::vanish));
  say(device[0], "anybody?");
  EXPECT_EQ(next(bench, 20ms), "-");
  ::fcntl(device[0].get(), F_SETFL, O_NONBLOCK);
  EXPECT_EQ(hear(device[0]), "EAGAIN") << "neither FIN nor RST";
  ::fcntl(device[0].get(), F_SETFL, 0);
  bench.end_all();
  EXPECT_EQ(hear(device[0]), "ECONNRESET") << "it keeps no place for the next case";
}

TEST_F(BenchSocketsTest, ARefusedConnectionIsAResetLink) {
  const std::uint16_t nobody = test::port_of(listener);
  listener.reset();
  Result<UniqueFd> fd = host->connect(nobody, SOCK_STREAM);
  ASSERT_TRUE(fd) << fd.error().message;
  EXPECT_FALSE(*fd);
  bench.add(Transport::tcp, std::move(*fd), nobody);
  EXPECT_EQ(next(bench), "1 reset");
  EXPECT_EQ(next(bench, 0ns), "-");
}

TEST_F(BenchSocketsTest, OneThatFloodsDoesNotSilenceTheOthers) {
  open();
  open();
  const std::string flood(1'000'000, 'x');
  ::fcntl(device[0].get(), F_SETFL, O_NONBLOCK);
  ::send(device[0].get(), flood.data(), flood.size(), MSG_NOSIGNAL);
  say(device[1], "heard");
  EXPECT_THAT(next(bench), HasSubstr("1 data"));
  EXPECT_EQ(next(bench), "2 data 'heard'");
}

TEST_F(BenchSocketsTest, OneThatIsLongOverMayBeSentToAndClosedOnce) {
  open();
  break_off(device[0]);
  EXPECT_EQ(next(bench), "1 reset");
  for (LinkId link = 2; link < 5; ++link) EXPECT_EQ(open(), link);
  EXPECT_TRUE(bench.send(to_bytes("nobody hears it"), 1));
  EXPECT_TRUE(bench.close(1, Closing::fin));
  EXPECT_FALSE(bench.send(to_bytes("x"), 1));
  EXPECT_FALSE(bench.close(1, Closing::fin));
  EXPECT_FALSE(bench.send(to_bytes("x"), 9)) << "there never was one";
}

TEST_F(BenchSocketsTest, EndingAllEndsWhatWasAndNumbersAreNotUsedAgain) {
  open();
  say(device[0], "of the case before");
  bench.end_all();
  EXPECT_EQ(next(bench, 0ns), "-");
  EXPECT_FALSE(bench.send(to_bytes("x"), 1));
  EXPECT_EQ(open(), 2u);
}

TEST_F(BenchSocketsTest, AnInterruptEndsTheWait) {
  open();
  interrupt();
  const Result<Burst> burst = bench.receive(bench.now() + 60s);
  clear_interrupt();
  ASSERT_FALSE(burst);
  EXPECT_TRUE(burst.error().interrupted);
}

TEST_F(BenchSocketsTest, ADeviceThatReadsNothingIsTrouble) {
  open();
  bench.set_send_limit(10ms);
  const Bytes much(1 << 20, 'x');
  Result<Sent> sent = Sent{};
  for (int i = 0; i < 64 && sent; ++i) sent = bench.send(much, 1);
  ASSERT_FALSE(sent);
  EXPECT_THAT(sent.error().message, HasSubstr("the far end takes no more bytes"));
}

class Datagrams : public testing::Test {
 protected:
  LinkId open() {
    Result<UniqueFd> fd = host->connect(test::port_of(device), SOCK_DGRAM);
    EXPECT_TRUE(fd) << fd.error().message;
    return bench.add(Transport::udp, std::move(*fd), test::port_of(device));
  }
  /// The next datagram that the device gets; answers go to its sender.
  std::string hear_from() {
    std::string text(65'536, ' ');
    socklen_t size = sizeof client;
    const ssize_t n = ::recvfrom(device.get(), text.data(), text.size(), 0,
                                 reinterpret_cast<sockaddr*>(&client), &size);
    return n < 0 ? "!" : text.substr(0, static_cast<std::size_t>(n));
  }
  void answer(const std::string& text) {
    EXPECT_EQ(::sendto(device.get(), text.data(), text.size(), 0,
                       reinterpret_cast<sockaddr*>(&client), sizeof client),
              static_cast<ssize_t>(text.size()));
  }
  UniqueFd device = bound(SOCK_DGRAM);
  sockaddr_in client{};
  Result<RemoteHost> host = RemoteHost::find("127.0.0.1");
  BenchSockets bench{"udp:test"};
};

TEST_F(Datagrams, EachLinkIsAPortOfItsOwnAndOneSendOneDatagram) {
  open();
  open();
  ASSERT_TRUE(bench.send(to_bytes("one"), 1));
  ASSERT_TRUE(bench.send(to_bytes("two"), 1));
  EXPECT_EQ(hear_from(), "one");
  const in_port_t first = client.sin_port;
  EXPECT_EQ(hear_from(), "two");
  EXPECT_EQ(client.sin_port, first);
  ASSERT_TRUE(bench.send(to_bytes("three"), 2));
  EXPECT_EQ(hear_from(), "three");
  EXPECT_NE(client.sin_port, first);
  answer("to two");
  EXPECT_EQ(next(bench), "2 datagram 'to two'");
}

TEST_F(Datagrams, AnEmptyOneIsOneAndSaysWhereItCameFrom) {
  open();
  ASSERT_TRUE(bench.send({}, 1));
  EXPECT_EQ(hear_from(), "");
  answer("");
  const Result<Burst> burst = bench.receive(bench.now() + 5s);
  ASSERT_TRUE(burst);
  EXPECT_EQ(burst->event, LinkEvent::datagram);
  EXPECT_EQ(burst->link, 1u);
  EXPECT_EQ(burst->port, test::port_of(device));
  EXPECT_EQ(burst->peer, "127.0.0.1:" + std::to_string(test::port_of(device)));
  EXPECT_TRUE(burst->bytes.empty());
}

TEST_F(Datagrams, APortThatNobodyHasIsAResetAndMayComeBack) {
  const std::uint16_t port = test::port_of(device);
  open();
  device.reset();
  ASSERT_TRUE(bench.send(to_bytes("anybody?"), 1));
  EXPECT_EQ(next(bench), "1 reset");
  device = bound(SOCK_DGRAM, port);
  ASSERT_TRUE(bench.send(to_bytes("again"), 1));
  EXPECT_EQ(hear_from(), "again");
}

TEST_F(Datagrams, OneThatIsTooLongIsAnError) {
  open();
  const Result<Sent> sent = bench.send(Bytes(65'508), 1);
  ASSERT_FALSE(sent);
  EXPECT_EQ(sent.error().message, "cannot send to udp:test: a datagram holds at most 65507 bytes");
}

class Listening : public testing::Test {
 protected:
  void SetUp() override {
    for (const int type : {SOCK_STREAM, SOCK_DGRAM}) {
      Result<UniqueFd> fd = listen_socket({"127.0.0.1", 0}, type);
      ASSERT_TRUE(fd) << fd.error().message;
      (type == SOCK_STREAM ? tcp : udp) = local_address(fd->get()).port();
      bench.listen(std::move(*fd), type == SOCK_STREAM ? Transport::tcp : Transport::udp, 502);
    }
  }
  std::uint16_t tcp = 0, udp = 0;
  BenchSockets bench{"listen:test"};
};

TEST_F(Listening, AConnectionOfTheDeviceIsTold) {
  const UniqueFd device = test::connected(SOCK_STREAM, tcp);
  say(device, "request");
  const Result<Burst> opened = bench.receive(bench.now() + 5s);
  ASSERT_TRUE(opened) << opened.error().message;
  EXPECT_EQ(opened->event, LinkEvent::opened);
  EXPECT_EQ(opened->link, first_own_link);
  EXPECT_EQ(opened->port, 502);
  EXPECT_EQ(opened->peer, "127.0.0.1:" + std::to_string(test::port_of(device)));
  EXPECT_EQ(next(bench), "0 data 'request'");
  ASSERT_TRUE(bench.send(to_bytes("reply"), opened->link));
  EXPECT_EQ(hear(device), "reply");
}

TEST_F(Listening, TheEndOfOneConnectionComesBeforeTheNextOne) {
  UniqueFd device = test::connected(SOCK_STREAM, tcp);
  EXPECT_EQ(next(bench), "0 opened");
  for (int i = 0; i < 20; ++i) {
    device.reset();
    device = test::connected(SOCK_STREAM, tcp);
    EXPECT_EQ(next(bench), std::to_string(i) + " closed");
    EXPECT_EQ(next(bench), std::to_string(i + 1) + " opened");
  }
}

TEST_F(Listening, ASenderOfDatagramsIsALink) {
  const UniqueFd one = test::connected(SOCK_DGRAM, udp), two = test::connected(SOCK_DGRAM, udp);
  say(one, "a");
  EXPECT_EQ(next(bench), "0 datagram 'a'");
  say(two, "b");
  EXPECT_EQ(next(bench), "1 datagram 'b'");
  say(one, "");
  EXPECT_EQ(next(bench), "0 datagram");
  ASSERT_TRUE(bench.send(to_bytes("to two"), first_own_link + 1));
  EXPECT_EQ(hear(two), "to two");
}

}  // namespace
}  // namespace fieldproof::os
