#include "harness/system/interrupt.hpp"

#include <sys/eventfd.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <stdexcept>

namespace fieldproof::os {

namespace {

std::atomic<bool> interrupt_came{false};
std::atomic<int> interrupt_event{-1};
std::atomic<int> hangup_event{-1};
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free,
              "signal handlers use them");

int new_event() {
  const int fd = ::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
  if (fd < 0)
    throw std::runtime_error(
        "cannot make an eventfd: no file descriptors left; raise the limit with ulimit -n");
  return fd;
}

/// Async-signal-safe.
void raise_event(int fd) {
  const int saved = errno;
  const std::uint64_t one = 1;
  [[maybe_unused]] const ssize_t written = ::write(fd, &one, sizeof one);
  errno = saved;
}

void on_interrupt(int) {
  interrupt_came = true;
  raise_event(interrupt_event);
}

void on_hangup(int) { raise_event(hangup_event); }

void handle(int signal, void (*handler)(int), unsigned flags) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = static_cast<int>(flags);
  sigemptyset(&action.sa_mask);
  ::sigaction(signal, &action, nullptr);
}

}  // namespace

int interrupt_fd() {
  static const int fd = interrupt_event = new_event();
  return fd;
}

void catch_interrupts() {
  (void)interrupt_fd();
  // No SA_RESTART: blocking calls return, and their loops ask interrupted().
  handle(SIGINT, on_interrupt, SA_RESETHAND);
  handle(SIGTERM, on_interrupt, SA_RESETHAND);
}

bool interrupted() { return interrupt_came; }

void interrupt() {
  (void)interrupt_fd();
  on_interrupt(0);
}

void clear_interrupt() {
  interrupt_came = false;
  std::uint64_t count = 0;
  [[maybe_unused]] const ssize_t got = ::read(interrupt_fd(), &count, sizeof count);
}

int catch_hangup() {
  static const int fd = hangup_event = new_event();
  handle(SIGHUP, on_hangup, 0);
  return fd;
}

}  // namespace fieldproof::os
