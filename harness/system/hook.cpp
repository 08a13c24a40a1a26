#include "harness/system/hook.hpp"

#include <poll.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fcntl.h>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>

#include "harness/system/interrupt.hpp"
#include "harness/system/system_calls.hpp"
#include "harness/system/unique_fd.hpp"

namespace fieldproof::os {

namespace {

/// True: `fd` has become readable; false: interrupted.
bool wait_readable(int fd) {
  std::array<pollfd, 2> fds{pollfd{fd, POLLIN, 0}, pollfd{interrupt_fd(), POLLIN, 0}};
  while (!interrupted()) {
    if (::poll(fds.data(), fds.size(), -1) > 0 && fds[0].revents != 0) return true;
    if (fds[1].revents != 0) break;
  }
  return false;
}

std::vector<char*> pointers(std::vector<std::string>& texts) {
  std::vector<char*> result;
  for (std::string& text : texts) result.push_back(text.data());
  result.push_back(nullptr);
  return result;
}

std::string how(int status) {
  if (WIFSIGNALED(status)) return "signal " + std::to_string(WTERMSIG(status)) + " ended it";
  return "exit status " + std::to_string(WEXITSTATUS(status));
}

}  // namespace

Status run_hook(const std::string& command, const std::vector<std::string>& arguments,
                const std::vector<std::pair<std::string, std::string>>& environment) {
  std::vector<std::string> words{"/bin/sh", "-c", command + " \"$@\"", "sh"};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<std::string> values;
  for (char** one = environ; *one; ++one) values.emplace_back(*one);
  for (const auto& [key, value] : environment) values.push_back(key + '=' + value);
  const std::vector<char*> argv = pointers(words), envp = pointers(values);
  const UniqueFd nothing(::open("/dev/null", O_RDONLY | O_CLOEXEC));
  // Our handlers live on in the child until it runs the command: a signal must not be lost in them.
  sigset_t all, before;
  ::sigfillset(&all);
  ::sigprocmask(SIG_SETMASK, &all, &before);
  const pid_t pid = ::fork();
  if (pid == 0) {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) ::signal(signal, SIG_DFL);
    ::sigprocmask(SIG_SETMASK, &before, nullptr);
    ::dup2(nothing.get(), STDIN_FILENO);
    ::dup2(STDERR_FILENO, STDOUT_FILENO);
    ::execve(argv[0], argv.data(), envp.data());
    ::_exit(127);
  }
  ::sigprocmask(SIG_SETMASK, &before, nullptr);
  if (pid < 0) return fail("cannot start '" + command + "': " + errno_text(errno));
  const UniqueFd end(static_cast<int>(::syscall(SYS_pidfd_open, pid, 0)));
  const bool ended = end && wait_readable(end.get());
  if (!ended) ::kill(pid, SIGTERM);
  int status = 0;
  while (::waitpid(pid, &status, 0) < 0 && errno == EINTR) {
  }
  if (!ended) return Error{"cannot run '" + command + "': interrupted", true};
  if (status != 0) return fail("the command '" + command + "' failed: " + how(status));
  return ok();
}

Result<std::string> ask(const std::string& question) {
  std::fputs(question.c_str(), stderr);
  std::fflush(stderr);
  std::string line;
  for (char c = 0;;) {
    if (!wait_readable(STDIN_FILENO)) return Error{"cannot read the answer: interrupted", true};
    const ssize_t count = ::read(STDIN_FILENO, &c, 1);
    if (count < 0 && (errno == EINTR || errno == EAGAIN)) continue;
    if (count <= 0) return fail("cannot read the answer: there is no input");
    if (c == '\n') return line;
    line += c;
  }
}

}  // namespace fieldproof::os
