#include "harness/system/system_calls.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>

#include <cctype>
#include <cerrno>
#include <system_error>

namespace fieldproof::os {

const SystemCalls& real_system_calls() {
  static const SystemCalls calls{
      .open = [](const char* path, int flags) { return ::open(path, flags); },
      .ioctl = [](int fd, unsigned long request,
                  void* argument) { return ::ioctl(fd, request, argument); },
      .flock = [](int fd, int operation) { return ::flock(fd, operation); },
      .device_major =
          [](int fd) {
            struct stat status {};
            if (::fstat(fd, &status) != 0 || !S_ISCHR(status.st_mode)) return -1;
            return static_cast<int>(gnu_dev_major(status.st_rdev));
          },
  };
  return calls;
}

std::string errno_text(int error) {
  std::string text = std::generic_category().message(error);
  if (text.size() > 1 && std::islower(static_cast<unsigned char>(text[1]))) {
    text[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(text[0])));
  }
  return text;
}

bool would_block(int error) { return error == EAGAIN || error == EWOULDBLOCK; }

}  // namespace fieldproof::os
