#include "harness/system/pty_pair.hpp"

#include <gmock/gmock.h>
#include <termios.h>

#include <numeric>

#include "harness/system/fd_link.hpp"
#include "harness/system/test_link.hpp"

namespace fieldproof::os {
namespace {

Bytes receive_all(FdLink& link, std::size_t size) {
  Bytes all;
  while (all.size() < size) {
    const Result<Burst> burst = link.receive(link.now() + 5s);
    if (!burst || burst->bytes.empty()) break;
    all.insert(all.end(), burst->bytes.begin(), burst->bytes.end());
  }
  return all;
}

TEST(PtyPair, IsCleanForAllBytesInBothDirections) {
  Result<PtyPair> pty = open_pty_pair();
  ASSERT_TRUE(pty) << pty.error().message;
  FdLink master(std::move(pty->master), "master");
  FdLink slave(std::move(pty->slave), "slave");
  Bytes every(256);
  std::iota(every.begin(), every.end(), Byte{0});
  ASSERT_TRUE(master.send(every));
  EXPECT_EQ(receive_all(slave, 256), every);
  ASSERT_TRUE(slave.send(every));
  EXPECT_EQ(receive_all(master, 256), every);
}

TEST(PtyPair, APeerThatAsksForParityIsNotRefused) {
  Result<PtyPair> pty = open_pty_pair();
  ASSERT_TRUE(pty);
  termios settings{};
  ASSERT_EQ(::tcgetattr(pty->slave.get(), &settings), 0);
  settings.c_cflag |= PARENB;
  EXPECT_EQ(::tcsetattr(pty->slave.get(), TCSANOW, &settings), -1)
      << "the trap itself is gone from this kernel: B50 is needless";
  ::cfsetspeed(&settings, B9600);
  EXPECT_EQ(::tcsetattr(pty->slave.get(), TCSANOW, &settings), 0);
}

TEST(PtyPair, DropsWhatWaitsAndWhatIsOnItsWay) {
  Result<PtyPair> pty = open_pty_pair();
  ASSERT_TRUE(pty);
  FdLink master(std::move(pty->master), "master");
  FdLink slave(std::move(pty->slave), "slave");
  for (int i = 0; i < 200; ++i) {
    ASSERT_TRUE(master.send(to_bytes("old")));
    ASSERT_TRUE(slave.send(to_bytes("old")));
    drop_waiting_bytes(master.fd());
    drop_waiting_bytes(slave.fd());
    drop_waiting_bytes(master.fd());
    ASSERT_TRUE(master.send(to_bytes("new")));
    ASSERT_TRUE(slave.send(to_bytes("new")));
    ASSERT_EQ(os::test::receive_text(slave, "new"), "new");
    ASSERT_EQ(os::test::receive_text(master, "new"), "new");
  }
}

}  // namespace
}  // namespace fieldproof::os
