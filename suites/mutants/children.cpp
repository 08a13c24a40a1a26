#include "suites/mutants/children.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <csignal>
#include <map>
#include <new>

#include "suites/mutants/shared_memory.hpp"

namespace fieldproof::mutants {

namespace {

void limit(double seconds) {
  const double whole = std::floor(seconds);
  itimerval timer{};
  timer.it_value.tv_sec = static_cast<time_t>(whole);
  timer.it_value.tv_usec = static_cast<suseconds_t>((seconds - whole) * 1e6);
  ::setitimer(ITIMER_PROF, &timer, nullptr);
}

/// What a mutant says of its own death is of no interest.
void be_quiet() {
  const int null = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  if (null >= 0) ::dup2(null, STDERR_FILENO);
  const rlimit no_core{0, 0};
  ::setrlimit(RLIMIT_CORE, &no_core);
}

[[noreturn]] void be_child(std::size_t item, const Effort& effort, int& noted,
                           const std::function<int(std::size_t, Steps&)>& work) {
  be_quiet();
  if (effort.memory) {
    const rlimit memory{effort.memory, effort.memory};
    ::setrlimit(RLIMIT_AS, &memory);
  }
  limit(effort.seconds);
  Steps steps(noted, effort.seconds);
  noted = work(item, steps);
  ::_exit(0);
}

Ended ended(int status, int value) {
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return {Ended::How::returned, value};
  const bool hung = WIFSIGNALED(status) && WTERMSIG(status) == SIGPROF;
  return {hung ? Ended::How::hung : Ended::How::crashed, value};
}

}  // namespace

void Steps::next(int value) {
  noted_ = value;
  limit(seconds_);
}

std::vector<Ended> in_children(std::size_t count, const Effort& effort,
                               const std::function<int(std::size_t, Steps&)>& work,
                               const std::function<void(std::size_t)>& begin,
                               const std::function<void(std::size_t, const Ended&)>& end) {
  std::vector<Ended> result(count);
  SharedMemory<int> noted(count);
  std::map<pid_t, std::size_t> running;
  std::size_t next = 0;
  while (next < count || !running.empty()) {
    if (next < count && running.size() < effort.jobs) {
      if (begin) begin(next);
      const pid_t child = ::fork();
      if (child < 0) throw std::bad_alloc();
      if (child == 0) be_child(next, effort, noted[next], work);
      running[child] = next++;
      continue;
    }
    int status = 0;
    const auto one = running.find(::wait(&status));
    if (one == running.end()) continue;
    const std::size_t item = one->second;
    running.erase(one);
    result[item] = ended(status, noted[item]);
    if (end) end(item, result[item]);
  }
  return result;
}

}  // namespace fieldproof::mutants
