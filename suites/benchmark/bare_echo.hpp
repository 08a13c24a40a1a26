// What no harness could beat: another process that answers so many bytes with so many others.
#pragma once

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <stdexcept>

#include "src/base/bytes.hpp"

namespace fieldproof::suites {

/// Answers `request` bytes on `device`, a pty or a connection, with `reply` bytes.
class BareEcho {
 public:
  BareEcho(int device, std::size_t request, std::size_t reply) : child_(fork()) {
    if (child_ != 0) return;
    prctl(PR_SET_PDEATHSIG, SIGKILL);  // and no descriptor of the bench is kept from closing
    close_range(3, static_cast<unsigned>(device) - 1, 0);
    close_range(static_cast<unsigned>(device) + 1, ~0U, 0);
    Bytes buffer(256);
    const Bytes answer(reply, 'x');
    for (std::size_t have = 0;;) {
      const ssize_t got = read(device, buffer.data(), buffer.size());
      if (got <= 0) _exit(0);
      have += static_cast<std::size_t>(got);
      if (have < request) continue;
      have = 0;
      if (write(device, answer.data(), answer.size()) < 0) _exit(1);
    }
  }
  ~BareEcho() {
    kill(child_, SIGKILL);
    waitpid(child_, nullptr, 0);
  }

 private:
  pid_t child_;
};

inline void make_blocking(int fd) { fcntl(fd, F_SETFL, fcntl(fd, F_GETFL) & ~O_NONBLOCK); }

/// Of a descriptor that blocks.
inline void bare_round_trip(int bench, const Bytes& request, std::size_t reply) {
  Bytes buffer(256);
  if (write(bench, request.data(), request.size()) < 0)
    throw std::runtime_error("bare write failed");
  for (std::size_t have = 0; have < reply;) {
    const ssize_t got = read(bench, buffer.data(), buffer.size());
    if (got <= 0) throw std::runtime_error("bare read failed");
    have += static_cast<std::size_t>(got);
  }
}

}  // namespace fieldproof::suites
