#include "harness/system/child_process.hpp"

#include <fcntl.h>
#include <linux/close_range.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/ioctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>

#include <array>
#include <boost/process/args.hpp>
#include <boost/process/child.hpp>
#include <boost/process/error.hpp>
#include <boost/process/exe.hpp>
#include <boost/process/extend.hpp>
#include <cerrno>
#include <csignal>
#include <cstring>

#include "harness/system/system_calls.hpp"

namespace fieldproof::os {

namespace {

constexpr std::size_t said_limit = 4096;
constexpr std::size_t kept_answers = 64;
constexpr std::size_t said_lines = 5;
constexpr int term_limit_ms = 1000;

/// Between fork and exec: only async-signal-safe calls.
void prepare_child(const ChildOptions& options, int null, int standard_error) {
  ::setsid();
  if (options.terminal >= 0) ::ioctl(options.terminal, TIOCSCTTY, 0);
  ::dup2(options.terminal_is_stdio     ? options.terminal
         : options.standard_input >= 0 ? options.standard_input
                                       : null,
         STDIN_FILENO);
  ::dup2(options.terminal_is_stdio ? options.terminal : standard_error, STDOUT_FILENO);
  ::dup2(standard_error, STDERR_FILENO);
  // Boost.Process leaks every descriptor, and its limit_handles closes the redirected stdout.
  ::close_range(3, ~0U, CLOSE_RANGE_CLOEXEC);
  for (const int fd : options.keep) ::fcntl(fd, F_SETFD, 0);
}

}  // namespace

std::vector<std::string> shell(const std::string& command) { return {"/bin/sh", "-c", command}; }

Result<std::unique_ptr<ChildProcess>> ChildProcess::start(const ChildOptions& options) {
  namespace bp = boost::process;
  const auto failed = [&](const std::string& why) {
    return fail("cannot start " + options.arguments.front() + ": " + why);
  };
  std::array<int, 2> pipe_ends{};
  if (::pipe2(pipe_ends.data(), O_CLOEXEC) != 0) return failed(errno_text(errno));
  UniqueFd readable(pipe_ends[0]);
  const UniqueFd writable(pipe_ends[1]);
  ::fcntl(readable.get(), F_SETFL, O_NONBLOCK);
  const UniqueFd null(::open("/dev/null", O_RDWR | O_CLOEXEC));
  if (!null) return failed("cannot open /dev/null: " + errno_text(errno));

  std::error_code error;
  const std::vector<std::string> rest(options.arguments.begin() + 1, options.arguments.end());
  bp::child child(
      bp::exe = options.arguments.front(), bp::args = rest, error,
      bp::extend::on_exec_setup = [&](auto&) {
        prepare_child(options, null.get(), writable.get());
      });
  if (error) return failed(errno_text(error.value()));
  const pid_t pid = child.id();
  child.detach();  // we reap it ourselves
  // Not by <sys/pidfd.h>: that of glibc 2.36 lacks extern "C".
  UniqueFd pid_fd(static_cast<int>(::syscall(SYS_pidfd_open, pid, 0)));
  if (!pid_fd) {
    const int cause = errno;
    ::kill(-pid, SIGKILL);
    ::waitpid(pid, nullptr, 0);
    return failed("no descriptor of the process: " + errno_text(cause));
  }
  return std::unique_ptr<ChildProcess>(
      new ChildProcess(pid, std::move(pid_fd), std::move(readable)));
}

ChildProcess::ChildProcess(pid_t pid, UniqueFd pid_fd, UniqueFd standard_error)
    : pid_(pid),
      pid_fd_(std::move(pid_fd)),
      standard_error_(std::move(standard_error)),
      stop_(::eventfd(0, EFD_CLOEXEC)) {
  watcher_ = std::thread([this] { watch(); });
}

ChildProcess::~ChildProcess() {
  ::kill(-pid_, SIGTERM);
  pollfd over{pid_fd_.get(), POLLIN, 0};
  int ready = 0;
  do {
    ready = ::poll(&over, 1, term_limit_ms);
  } while (ready < 0 && errno == EINTR);
  // Not yet reaped, its number still means this group: what is left of it ends too.
  ::kill(-pid_, SIGKILL);
  while (::waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) {
  }
  ::eventfd_write(stop_.get(), 1);
  watcher_.join();
}

void ChildProcess::watch() {
  // Signals belong to the thread that waits for the interrupt.
  sigset_t all;
  sigfillset(&all);
  ::pthread_sigmask(SIG_BLOCK, &all, nullptr);
  std::array<pollfd, 3> fds{pollfd{stop_.get(), POLLIN, 0},
                            pollfd{standard_error_.get(), POLLIN, 0},
                            pollfd{pid_fd_.get(), POLLIN, 0}};
  while (fds[0].revents == 0) {
    if (::poll(fds.data(), fds.size(), -1) < 0) continue;
    if (fds[1].revents & POLLIN)
      read_standard_error();
    else if (fds[1].revents != 0)
      fds[1].fd = -1;  // all writers closed it
    if (fds[2].revents != 0) {
      ended_ = true;
      fds[2].fd = -1;
      const std::lock_guard lock(mutex_);
      said_more_.notify_all();
    }
  }
}

void ChildProcess::read_standard_error() {
  const std::lock_guard lock(mutex_);
  std::array<char, 4096> buffer;
  const ssize_t n = ::read(standard_error_.get(), buffer.data(), buffer.size());
  if (n <= 0) return;
  const std::string_view more(buffer.data(), static_cast<std::size_t>(n));
  look_for_answers(more);
  said_ += more;
  if (said_.size() > said_limit) said_.erase(0, said_.size() - said_limit);
}

void ChildProcess::look_for_answers(std::string_view more) {
  for (const char c : more) {
    if (c == '\n') {
      if (line_.starts_with('{')) answers_.push_back(line_);
      if (answers_.size() > kept_answers) answers_.pop_front();
      line_.clear();
    } else if (line_.size() < said_limit) {
      line_ += c;
    }
  }
  if (!answers_.empty()) said_more_.notify_all();
}

std::string ChildProcess::answer(Duration patience) {
  read_standard_error();  // what was said before this moment is in the pipe
  std::unique_lock lock(mutex_);
  said_more_.wait_for(lock, patience, [&] { return !answers_.empty() || ended_; });
  if (answers_.empty()) return {};
  std::string answer = std::move(answers_.front());
  answers_.pop_front();
  return answer;
}

std::string ChildProcess::last_lines() {
  // What it said before its end is in the pipe by now. The bound is for a grandchild that goes on
  // writing.
  for (int i = 0; i < 16; ++i) read_standard_error();
  const std::lock_guard lock(mutex_);
  std::string text = said_;
  while (!text.empty() && text.back() == '\n') text.pop_back();
  std::size_t from = text.size();
  for (std::size_t lines = 0; lines < said_lines && from != std::string::npos && from > 0;
       ++lines) {
    from = text.rfind('\n', from - 1);
  }
  return from == std::string::npos || from == 0 ? text : text.substr(from + 1);
}

std::string ChildProcess::how() {
  siginfo_t info{};
  std::string text = "the process still runs";
  if (::waitid(P_PIDFD, static_cast<id_t>(pid_fd_.get()), &info, WEXITED | WNOHANG | WNOWAIT) ==
          0 &&
      info.si_pid != 0) {
    ended_ = true;
    text = info.si_code == CLD_EXITED
               ? "the process ended with exit status " + std::to_string(info.si_status)
               : "the process was ended by signal " + std::to_string(info.si_status) + " (" +
                     ::strsignal(info.si_status) + ')';
  }
  if (const std::string said = last_lines(); !said.empty()) text += "; it said: " + said;
  return text;
}

}  // namespace fieldproof::os
