// The system calls that a serial port needs, so that tests can stand in for drivers: a pty answers
// ENOTTY to RS-485, modem lines and error counters.
#pragma once

#include <functional>
#include <string>

namespace fieldproof::os {

/// Each as the system call of its name: -1 and errno on failure.
struct SystemCalls {
  std::function<int(const char* path, int flags)> open;
  std::function<int(int fd, unsigned long request, void* argument)> ioctl;
  std::function<int(int fd, int operation)> flock;
  /// The major number of the character device, or -1 when it is none. 136-143 are pty slaves.
  std::function<int(int fd)> device_major;
};

const SystemCalls& real_system_calls();

/// "permission denied"
std::string errno_text(int error);
/// Is there only nothing to read, or no room to write, at this moment?
bool would_block(int error);

}  // namespace fieldproof::os
