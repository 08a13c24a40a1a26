#include "harness/system/child_process.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <poll.h>
#include <sys/socket.h>

#include <array>
#include <csignal>

namespace fieldproof::os {
namespace {

using testing::HasSubstr;

std::unique_ptr<ChildProcess> run(const std::string& command, std::vector<int> keep = {}) {
  ChildOptions options;
  options.arguments = shell(command);
  options.keep = std::move(keep);
  Result<std::unique_ptr<ChildProcess>> child = ChildProcess::start(options);
  EXPECT_TRUE(child) << child.error().message;
  return child ? std::move(*child) : nullptr;
}

bool ends(const ChildProcess& child) {
  pollfd end{child.end_fd(), POLLIN, 0};
  return ::poll(&end, 1, 10'000) == 1;
}

TEST(ChildProcess, TellsExitStatusAndLastLines) {
  const auto child = run("for i in 1 2 3 4 5 6 7; do echo line $i >&2; done; exit 3");
  ASSERT_TRUE(ends(*child));
  EXPECT_EQ(
      child->how(),
      "the process ended with exit status 3; it said: line 3\nline 4\nline 5\nline 6\nline 7");
  EXPECT_TRUE(child->ended());
}

TEST(ChildProcess, TellsTheSignal) {
  const auto child = run("kill -KILL $$");
  ASSERT_TRUE(ends(*child));
  EXPECT_EQ(child->how(), "the process was ended by signal 9 (Killed)");
}

TEST(ChildProcess, TellsThatItStillRuns) {
  const auto child = run("exec cat /dev/zero");
  EXPECT_THAT(child->how(), HasSubstr("the process still runs"));
  EXPECT_FALSE(child->ended());
}

TEST(ChildProcess, IsNeverBlockedByWhatItSays) {
  const auto child = run("head -c 1000000 /dev/zero | tr '\\0' x >&2; echo >&2; echo done; exit 0");
  ASSERT_TRUE(ends(*child));
  EXPECT_THAT(child->how(), testing::AllOf(HasSubstr("exit status 0"), testing::EndsWith("done")));
}

TEST(ChildProcess, AMissingProgramIsAnError) {
  ChildOptions options;
  options.arguments = {"/nowhere/program"};
  const Result<std::unique_ptr<ChildProcess>> child = ChildProcess::start(options);
  ASSERT_FALSE(child);
  EXPECT_EQ(child.error().message, "cannot start /nowhere/program: no such file or directory");
}

TEST(ChildProcess, InheritsOnlyWhatItIsGiven) {
  std::array<int, 2> fds{};
  ASSERT_EQ(::socketpair(AF_UNIX, SOCK_STREAM, 0, fds.data()),
            0);  // deliberately not close-on-exec
  const UniqueFd ours(fds[0]), theirs(fds[1]);
  const std::string kept = std::to_string(theirs.get()), other = std::to_string(ours.get());
  const auto child = run("test -e /proc/$$/fd/" + kept + " && echo kept >&2; test -e /proc/$$/fd/" +
                             other + " && echo leaked >&2; exit 0",
                         {theirs.get()});
  ASSERT_TRUE(ends(*child));
  EXPECT_EQ(child->how(), "the process ended with exit status 0; it said: kept");
}

TEST(ChildProcess, EndsWithItsChildren) {
  std::array<int, 2> fds{};
  ASSERT_EQ(::pipe2(fds.data(), O_CLOEXEC), 0);
  const UniqueFd readable(fds[0]);
  UniqueFd writable(fds[1]);
  // The grandchild ignores SIGTERM, and holds the pipe open as long as it lives.
  auto child = run("(trap '' TERM; echo up >&" + std::to_string(writable.get()) +
                       "; while :; do sleep 1000; done) & wait",
                   {writable.get()});
  writable.reset();
  std::array<char, 8> text{};
  ASSERT_EQ(::read(readable.get(), text.data(), text.size()), 3);
  child.reset();
  pollfd end{readable.get(), POLLIN, 0};
  ASSERT_EQ(::poll(&end, 1, 10'000), 1);
  EXPECT_EQ(::read(readable.get(), text.data(), text.size()), 0);
}

TEST(ChildProcess, OneThatIgnoresTermIsKilled) {
  auto child = run("trap '' TERM; echo up >&2; while :; do sleep 1000; done");
  const pid_t pid = child->pid();
  child.reset();
  EXPECT_EQ(::kill(pid, 0), -1);
}

}  // namespace
}  // namespace fieldproof::os
