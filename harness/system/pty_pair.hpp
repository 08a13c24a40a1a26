// Two ends of a pseudo terminal, 8-bit clean in both directions.
#pragma once

#include <string>

#include "harness/system/unique_fd.hpp"
#include "src/base/result.hpp"

namespace fieldproof::os {

struct PtyPair {
  UniqueFd master;   // non-blocking
  UniqueFd slave;    // blocking: may become the stdio of a child. Kept open, so that nobody's close
                     // ends the line
  std::string path;  // of the slave: "/dev/pts/4"
};

/// Raw, close-on-exec, at 50 bit/s: a peer that changes only the parity is refused by a pty
/// (EINVAL), one that changes the speed too is not.
Result<PtyPair> open_pty_pair();

/// Sets a terminal raw at 50 bit/s (see above): no echo, no line editing, no signals, no flow
/// control. False: errno.
bool set_raw(int fd);

/// Drops what waits in either direction, unread or on its way; for either end of a pty.
void drop_waiting_bytes(int fd);

}  // namespace fieldproof::os
