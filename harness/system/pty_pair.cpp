#include "harness/system/pty_pair.hpp"

#include <fcntl.h>
#include <stdlib.h>
#include <sys/ioctl.h>
#include <termios.h>

#include <array>
#include <cerrno>

#include "harness/system/system_calls.hpp"

namespace fieldproof::os {

bool set_raw(int fd) {
  termios settings{};
  if (::tcgetattr(fd, &settings) != 0) return false;
  ::cfmakeraw(&settings);
  settings.c_cflag |= CLOCAL | CREAD;
  settings.c_cflag &= ~static_cast<tcflag_t>(CRTSCTS | HUPCL | CSTOPB);
  settings.c_cc[VMIN] = 1;
  settings.c_cc[VTIME] = 0;
  ::cfsetspeed(&settings, B50);
  return ::tcsetattr(fd, TCSANOW, &settings) == 0;
}

void drop_waiting_bytes(int fd) { ::tcflush(fd, TCIOFLUSH); }

Result<PtyPair> open_pty_pair() {
  const auto failed = [] {
    return fail("cannot open a pty: " + errno_text(errno) +
                "; see /proc/sys/kernel/pty/nr against max");
  };
  PtyPair pair;
  pair.master.reset(::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC | O_NONBLOCK));
  if (!pair.master || ::grantpt(pair.master.get()) != 0 || ::unlockpt(pair.master.get()) != 0)
    return failed();
  std::array<char, 64> path{};
  if (::ptsname_r(pair.master.get(), path.data(), path.size()) != 0) return failed();
  pair.path = path.data();
  pair.slave.reset(::open(path.data(), O_RDWR | O_NOCTTY | O_CLOEXEC));
  if (!pair.slave || !set_raw(pair.slave.get())) return failed();
  return pair;
}

}  // namespace fieldproof::os
