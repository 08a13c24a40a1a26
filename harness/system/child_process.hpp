// A program that the bench starts, watches and ends.
#pragma once

#include <sys/types.h>

#include <atomic>
#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "harness/system/fd_link.hpp"
#include "harness/system/unique_fd.hpp"
#include "src/base/result.hpp"

namespace fieldproof::os {

struct ChildOptions {
  std::vector<std::string> arguments;  // the program and its arguments
  std::vector<int>
      keep;  // descriptors that the child inherits under their numbers; no others above 2
  int terminal =
      -1;  // the slave of a pty: its hangup ends the child, even when the bench was killed
  int standard_input = -1;  // becomes its stdin
  bool terminal_is_stdio =
      false;  // stdin and stdout; else /dev/null, and stdout goes where stderr goes
};

/// The arguments that run `command` by the shell.
std::vector<std::string> shell(const std::string& command);

/// Runs in a session of its own, so that Ctrl-C does not reach it and its whole group can be ended.
/// Its stderr is read all the time, so that it never blocks on it; the last lines are kept.
class ChildProcess final : public FarEnd {
 public:
  static Result<std::unique_ptr<ChildProcess>> start(const ChildOptions& options);
  /// Ends the group: SIGTERM, and SIGKILL after a second.
  ~ChildProcess() override;
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  pid_t pid() const { return pid_; }
  int end_fd() const override { return pid_fd_.get(); }
  bool ended() const override { return ended_; }
  /// "the process ended with exit status 3; it said: ..." (the last lines of stderr), or that it
  /// still runs.
  std::string how() override;
  /// The next line of its output that begins with '{'; empty: it has said none within that time, or
  /// has ended without one. Of very many that nobody asked for the oldest are dropped.
  std::string answer(Duration patience);

 private:
  ChildProcess(pid_t pid, UniqueFd pid_fd, UniqueFd standard_error);
  void watch();
  void read_standard_error();
  void look_for_answers(std::string_view more);
  std::string last_lines();

  pid_t pid_;
  UniqueFd pid_fd_;
  UniqueFd standard_error_;
  UniqueFd stop_;  // wakes the watcher for its end
  std::atomic<bool> ended_{false};
  std::mutex mutex_;  // guards what follows
  std::string said_;
  std::string line_;                 // that is not complete yet
  std::deque<std::string> answers_;  // what answer() waits for
  std::condition_variable said_more_;
  std::thread watcher_;
};

}  // namespace fieldproof::os
