#include "harness/system/terminal.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/ioctl.h>
#include <cstdlib>

#include "harness/system/pty_pair.hpp"

namespace fieldproof::os {
namespace {

/// Ours is nobody's business here.
class TerminalColumns : public testing::Test {
 protected:
  TerminalColumns() {
    ::unsetenv("COLUMNS");
    EXPECT_TRUE(pty_);
  }
  ~TerminalColumns() override { ::unsetenv("COLUMNS"); }

  void resize(unsigned short columns) {
    const winsize size{24, columns, 0, 0};
    ASSERT_EQ(::ioctl(pty_->slave.get(), TIOCSWINSZ, &size), 0);
  }

  Result<PtyPair> pty_ = open_pty_pair();
  UniqueFd file_{::open("/dev/null", O_WRONLY | O_CLOEXEC)};
};

TEST_F(TerminalColumns, AreThoseOfTheTerminal) {
  resize(132);
  EXPECT_EQ(terminal_columns(pty_->slave.get()), 132);
  resize(3);
  EXPECT_EQ(terminal_columns(pty_->slave.get()), 20) << "the least that can be read";
}

TEST_F(TerminalColumns, AreEightyWhereTheTerminalDoesNotSay) {
  resize(0);
  EXPECT_EQ(terminal_columns(pty_->slave.get()), 80);
}

TEST_F(TerminalColumns, OfAFileAreNone) { EXPECT_EQ(terminal_columns(file_.get()), 0); }

TEST_F(TerminalColumns, AreWhatTheUserSays) {
  resize(132);
  for (const int fd : {pty_->slave.get(), file_.get()}) {
    ::setenv("COLUMNS", "100", 1);
    EXPECT_EQ(terminal_columns(fd), 100);
  }
  ::setenv("COLUMNS", "wide", 1);
  EXPECT_EQ(terminal_columns(pty_->slave.get()), 132);
}

}  // namespace
}  // namespace fieldproof::os
