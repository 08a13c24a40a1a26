#include "harness/system/fd_link.hpp"

#include <gmock/gmock.h>
#include <sys/socket.h>

#include <csignal>
#include <thread>

#include "harness/system/interrupt.hpp"
#include "harness/system/pty_pair.hpp"
#include "harness/system/test_link.hpp"

namespace fieldproof::os {

namespace {

using os::test::receive_text;
using testing::HasSubstr;

struct Sockets {
  Sockets() {
    int ends[2];
    EXPECT_EQ(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends), 0);
    near.reset(ends[0]);
    far.reset(ends[1]);
  }
  void write_far(std::string_view text) const {
    ASSERT_EQ(::send(far.get(), text.data(), text.size(), 0), static_cast<ssize_t>(text.size()));
  }
  UniqueFd near, far;
};

TEST(FdLink, CarriesBytesBothWaysOverAPty) {
  Result<PtyPair> pty = open_pty_pair();
  ASSERT_TRUE(pty) << pty.error().message;
  FdLink master(std::move(pty->master), "master");
  FdLink slave(std::move(pty->slave), "slave");
  const Result<Sent> sent = master.send(to_bytes("question"));
  ASSERT_TRUE(sent) << sent.error().message;
  EXPECT_LE(sent->start, sent->end);
  EXPECT_LE(sent->end, master.now());
  EXPECT_EQ(receive_text(slave, "question"), "question");
  ASSERT_TRUE(slave.send(to_bytes("answer")));
  EXPECT_EQ(receive_text(master, "answer"), "answer");
}

TEST(FdLink, AnEmptyBurstAtTheDeadline) {
  Sockets sockets;
  FdLink link(std::move(sockets.near), "socket");
  const Time deadline = link.now() + 20ms;
  const Result<Burst> burst = link.receive(deadline);
  ASSERT_TRUE(burst);
  EXPECT_TRUE(burst->bytes.empty());
  EXPECT_GE(link.now(), deadline);
}

TEST(FdLink, ADeadlineInThePastTakesWhatIsThere) {
  Sockets sockets;
  FdLink link(std::move(sockets.near), "socket");
  sockets.write_far("there");
  const Result<Burst> burst = link.receive(Time{0});
  ASSERT_TRUE(burst);
  EXPECT_EQ(to_text(burst->bytes), "there");
  EXPECT_EQ(burst->character_time, Duration::zero());
  const Result<Burst> nothing = link.receive(Time{0});
  ASSERT_TRUE(nothing);
  EXPECT_TRUE(nothing->bytes.empty());
}

TEST(FdLink, SaysThatASocketWasClosed) {
  Sockets sockets;
  FdLink link(std::move(sockets.near), "tcp:h:1");
  sockets.write_far("last");
  sockets.far.reset();
  EXPECT_EQ(receive_text(link, "last"), "last");
  EXPECT_FALSE(link.dead());
  EXPECT_THAT(os::test::receive_error(link).message,
              HasSubstr("cannot receive from tcp:h:1: the far end closed the connection"));
  EXPECT_TRUE(link.dead());
  const Result<Sent> sent = link.send(to_bytes("x"));
  ASSERT_FALSE(sent);
  EXPECT_THAT(sent.error().message,
              HasSubstr("cannot send to tcp:h:1: the connection broke (broken pipe)"));
}

TEST(FdLink, SaysThatTheOtherEndOfAPtyIsGone) {
  Result<PtyPair> pty = open_pty_pair();
  ASSERT_TRUE(pty);
  FdLink link(std::move(pty->slave), "serial:/dev/x");
  pty->master.reset();
  EXPECT_THAT(os::test::receive_error(link).message,
              HasSubstr("cannot receive from serial:/dev/x: the far end is gone"));
  const Result<Sent> sent = link.send(to_bytes("x"));
  ASSERT_FALSE(sent);
  EXPECT_THAT(sent.error().message, HasSubstr("the far end is gone"));
}

TEST(FdLink, SendsMoreThanTheBuffersHold) {
  Result<PtyPair> pty = open_pty_pair();
  ASSERT_TRUE(pty);
  FdLink master(std::move(pty->master), "master");
  FdLink slave(std::move(pty->slave), "slave");
  Bytes sent(200'000);
  for (std::size_t i = 0; i < sent.size(); ++i) sent[i] = static_cast<Byte>(i * 7 + i / 256);
  Bytes received;
  std::thread reader([&] {
    while (received.size() < sent.size()) {
      const Result<Burst> burst = slave.receive(slave.now() + 5s);
      if (!burst || burst->bytes.empty()) return;
      received.insert(received.end(), burst->bytes.begin(), burst->bytes.end());
    }
  });
  const Result<Sent> done = master.send(sent);
  reader.join();
  EXPECT_TRUE(done) << done.error().message;
  EXPECT_EQ(received, sent);
}

TEST(FdLink, AFarEndThatDoesNotReadIsAnError) {
  Result<PtyPair> pty = open_pty_pair();
  ASSERT_TRUE(pty);
  FdLink link(std::move(pty->master), "exec:stuck");
  link.set_send_limit(20ms);
  const Result<Sent> sent = link.send(Bytes(100'000, 'x'));
  ASSERT_FALSE(sent);
  EXPECT_THAT(sent.error().message,
              HasSubstr("cannot send to exec:stuck: the far end takes no more bytes"));
}

TEST(FdLink, OnAWireSentBytesEndByTheCharacterTime) {
  Sockets sockets;
  FdLink link(std::move(sockets.near), "wire");
  link.set_character_time(1ms);
  const Result<Sent> first = link.send(to_bytes("0123456789"));
  ASSERT_TRUE(first);
  EXPECT_EQ(first->end - first->start, 10ms);
  EXPECT_GE(link.now(), first->end);
  const Result<Sent> second = link.send(to_bytes("01"));
  ASSERT_TRUE(second);
  EXPECT_GE(second->start, first->end);
  EXPECT_EQ(second->end - second->start, 2ms);
}

TEST(FdLink, OnAWireReceivedBytesBeganByTheCharacterTimeButNeverOverlap) {
  Sockets sockets;
  FdLink link(std::move(sockets.near), "wire");
  link.set_character_time(2ms);
  ASSERT_TRUE(link.receive(link.now() + 15ms));  // silence long enough for five characters
  sockets.write_far("01234");
  const Result<Burst> first = link.receive(link.now() + 5s);
  ASSERT_TRUE(first);
  EXPECT_EQ(first->character_time, 2ms);
  EXPECT_EQ(first->end() - first->start, 10ms);
  sockets.write_far(
      "a hundred characters cannot have come in no time, so they are said to have come in the time "
      "there was");
  const Result<Burst> second = link.receive(link.now() + 5s);
  ASSERT_TRUE(second);
  EXPECT_GE(second->start, first->end());
  EXPECT_LE(second->end(), link.now());
}

TEST(FdLink, AnInterruptEndsReceive) {
  Sockets sockets;
  FdLink link(std::move(sockets.near), "socket");
  catch_interrupts();
  std::thread signaller([] { ::kill(::getpid(), SIGINT); });
  const Result<Burst> burst = link.receive(link.now() + 10s);
  signaller.join();
  ASSERT_FALSE(burst);
  EXPECT_TRUE(burst.error().interrupted);
  EXPECT_LT(link.now(), 5s);
  const Result<Sent> sent = link.send(to_bytes("x"));
  ASSERT_FALSE(sent);
  EXPECT_TRUE(sent.error().interrupted);
  clear_interrupt();
  sockets.write_far("again");
  EXPECT_EQ(receive_text(link, "again"), "again");
}

}  // namespace
}  // namespace fieldproof::os
