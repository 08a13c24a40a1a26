// Runs programs for the tests of the built tool: start, signals, deadline, what they printed.
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/inotify.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "reports/results/whole_file.hpp"

namespace fieldproof::tool_tests {

/// How a program ended. `code` is its exit code, 128 + signal where a signal ended it, -1 where it
/// missed the deadline.
struct Finished {
  int code = -1;
  std::string out, err;
  long peak_kib = 0;  // resident memory
};

/// A folder that goes with the test.
class TestFolder {
 public:
  TestFolder() {
    std::string pattern =
        (std::filesystem::temp_directory_path() / "fieldproof_test_XXXXXX").string();
    if (::mkdtemp(pattern.data())) path_ = pattern;
    EXPECT_FALSE(path_.empty()) << "cannot make a folder in "
                                << std::filesystem::temp_directory_path();
  }
  ~TestFolder() {
    std::error_code ignored;
    if (!path_.empty()) std::filesystem::remove_all(path_, ignored);
  }
  TestFolder(const TestFolder&) = delete;
  TestFolder& operator=(const TestFolder&) = delete;

  std::string operator/(const std::string& name) const { return (path_ / name).string(); }
  std::string path() const { return path_.string(); }

  /// Writes a file, with the folders above it; its path.
  std::string write(const std::string& name, const std::string& text) const {
    const std::filesystem::path file = path_ / name;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary) << text;
    return file.string();
  }

 private:
  std::filesystem::path path_;
};

inline std::string read_text(const std::string& path) {
  const Result<std::string> text = results::read_whole_file(path);
  return text ? *text : "";
}

inline std::vector<std::string> text_lines(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

struct ProcessOptions {
  std::vector<std::pair<std::string, std::string>> environment;  // added to ours
  std::string folder;                                            // where it runs; empty: here
};

/// A program that the test starts and ends. Not for two threads at once.
class Process {
 public:
  using Clock = std::chrono::steady_clock;
  using Limit = std::chrono::seconds;

  explicit Process(std::vector<std::string> arguments, const ProcessOptions& options = {})
      : name_(arguments.front()) {
    std::array<std::array<int, 2>, 2> pipes{};
    for (auto& one : pipes)
      if (::pipe2(one.data(), O_CLOEXEC) != 0)
        ADD_FAILURE() << "cannot make a pipe: " << std::strerror(errno);
    std::vector<char*> argv = pointers(arguments);
    std::vector<std::string> environment = environment_for(options);
    std::vector<char*> envp = pointers(environment);
    pid_ = ::fork();
    if (pid_ == 0) become(argv, envp, options.folder, pipes[0][1], pipes[1][1]);
    for (std::size_t i = 0; i < 2; ++i) {
      ::close(pipes[i][1]);
      ::fcntl(pipes[i][0], F_SETFL, O_NONBLOCK);
      streams_[i] = pipes[i][0];
    }
    pid_fd_ = static_cast<int>(::syscall(SYS_pidfd_open, pid_, 0));
    EXPECT_GE(pid_fd_, 0) << "cannot watch " << name_ << ": " << std::strerror(errno);
  }

  ~Process() {
    if (pid_ > 0) {
      ::kill(pid_, SIGKILL);
      ::waitpid(pid_, nullptr, 0);
    }
    for (int fd : {streams_[0], streams_[1], pid_fd_})
      if (fd >= 0) ::close(fd);
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  pid_t id() const { return pid_; }
  void signal(int number) { ::kill(pid_, number); }

  /// Until it has printed `text`; false where it ended or the limit came first.
  bool wait_for(const std::string& text, Limit limit = Limit(60)) {
    const Clock::time_point deadline = Clock::now() + limit;
    while (!printed(text))
      if (over(deadline)) return printed(text);
    return true;
  }

  /// Until its end. A program that misses the limit is killed.
  Finished wait(Limit limit = Limit(300)) {
    const Clock::time_point deadline = Clock::now() + limit;
    while (!over(deadline)) {
    }
    if (!ended_) ::kill(pid_, SIGKILL);
    int status = 0;
    rusage usage{};
    ::wait4(pid_, &status, 0, &usage);
    pid_ = -1;
    read_streams();
    Finished finished{-1, std::move(text_[0]), std::move(text_[1]), usage.ru_maxrss};
    if (!ended_)
      ADD_FAILURE() << name_ << " did not end within " << limit.count() << " s:\n"
                    << finished.out << finished.err;
    else
      finished.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    return finished;
  }

 private:
  static std::vector<char*> pointers(std::vector<std::string>& texts) {
    std::vector<char*> result;
    for (std::string& text : texts) result.push_back(text.data());
    result.push_back(nullptr);
    return result;
  }

  /// Ours, without what would steer the tool or its runner from outside.
  static std::vector<std::string> environment_for(const ProcessOptions& options) {
    std::vector<std::string> result;
    for (char** one = environ; *one; ++one) {
      const std::string text = *one;
      if (text.starts_with("GTEST_") || text.starts_with("FIELDPROOF_") ||
          text.starts_with("XML_OUTPUT_FILE") || text.starts_with("COLUMNS="))
        continue;
      const std::string key = text.substr(0, text.find('='));
      if (std::ranges::any_of(options.environment,
                              [&](const auto& given) { return given.first == key; }))
        continue;
      result.push_back(text);
    }
    for (const auto& [key, value] : options.environment) result.push_back(key + '=' + value);
    return result;
  }

  [[noreturn]] static void become(std::vector<char*>& argv, std::vector<char*>& envp,
                                  const std::string& folder, int out, int err) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    const int nothing = ::open("/dev/null", O_RDONLY);
    ::dup2(nothing, STDIN_FILENO);
    ::dup2(out, STDOUT_FILENO);
    ::dup2(err, STDERR_FILENO);
    if (folder.empty() || ::chdir(folder.c_str()) == 0)
      ::execvpe(argv[0], argv.data(), envp.data());
    ::dprintf(STDERR_FILENO, "cannot start %s: %s\n", argv[0], std::strerror(errno));
    ::_exit(127);
  }

  bool printed(const std::string& text) const {
    return std::ranges::any_of(
        text_, [&](const std::string& one) { return one.find(text) != std::string::npos; });
  }

  /// Waits for output or the end. True: it ended, or the deadline is over.
  bool over(Clock::time_point deadline) {
    std::array<pollfd, 3> fds{pollfd{streams_[0], POLLIN, 0}, pollfd{streams_[1], POLLIN, 0},
                              pollfd{pid_fd_, POLLIN, 0}};
    const auto left =
        std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now());
    const int ready =
        ::poll(fds.data(), fds.size(), static_cast<int>(std::max<long long>(0, left.count())));
    read_streams();
    ended_ = ended_ || fds[2].revents != 0;
    return ended_ || ready == 0;
  }

  void read_streams() {
    for (std::size_t i = 0; i < 2; ++i) {
      std::array<char, 65'536> buffer;
      ssize_t n = 0;
      while (streams_[i] >= 0 && (n = ::read(streams_[i], buffer.data(), buffer.size())) > 0)
        text_[i].append(buffer.data(), static_cast<std::size_t>(n));
      if (n != 0 || streams_[i] < 0) continue;
      ::close(streams_[i]);  // its end would wake poll for ever
      streams_[i] = -1;
    }
  }

  std::string name_;
  pid_t pid_ = -1;
  int pid_fd_ = -1;
  std::array<int, 2> streams_{-1, -1};
  std::array<std::string, 2> text_;
  bool ended_ = false;
};

inline Finished run_program(std::vector<std::string> arguments,
                            const ProcessOptions& options = {}) {
  return Process(std::move(arguments), options).wait();
}

inline std::vector<std::string> tool_arguments(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), FIELDPROOF_TOOL);
  return arguments;
}

/// The built tool.
inline Finished run_tool(std::vector<std::string> arguments, const ProcessOptions& options = {}) {
  return run_program(tool_arguments(std::move(arguments)), options);
}

/// Sees a file grow. Makes it, in a folder that is there.
class FileWatch {
 public:
  explicit FileWatch(const std::string& path) : path_(path), fd_(::inotify_init1(IN_CLOEXEC)) {
    std::ofstream(path_, std::ios::app);
    EXPECT_GE(::inotify_add_watch(fd_, path_.c_str(), IN_MODIFY), 0);
  }
  ~FileWatch() { ::close(fd_); }
  FileWatch(const FileWatch&) = delete;
  FileWatch& operator=(const FileWatch&) = delete;

  /// False: nothing came any more for a minute.
  bool wait_until(const auto& holds) const {
    pollfd changed{fd_, POLLIN, 0};
    while (!holds(read_text(path_))) {
      if (::poll(&changed, 1, 60'000) != 1) return false;
      char events[4096];
      [[maybe_unused]] const ssize_t got = ::read(fd_, events, sizeof events);
    }
    return true;
  }

 private:
  std::string path_;
  int fd_;
};

/// For a command line of the shell.
inline std::string quoted(const std::string& text) { return "'" + text + "'"; }

}  // namespace fieldproof::tool_tests
