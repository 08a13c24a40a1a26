#include "harness/system/line_pipe.hpp"

#include <sys/socket.h>
#include <sys/time.h>

#include <array>
#include <cerrno>

#include "harness/system/system_calls.hpp"

namespace fieldproof::os {

Result<LinePipe> open_line_pipe() {
  // A socket pair: writing to one that was closed raises no signal.
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0)
    return fail("cannot make a pipe: " + errno_text(errno));
  const timeval limit{5, 0};
  ::setsockopt(ends[0], SOL_SOCKET, SO_SNDTIMEO, &limit, sizeof limit);
  return LinePipe{UniqueFd(ends[0]), UniqueFd(ends[1])};
}

bool write_line(int fd, const std::string& line) {
  const std::string text = line + '\n';
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t n = ::send(fd, text.data() + done, text.size() - done, MSG_NOSIGNAL);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    done += static_cast<std::size_t>(n);
  }
  return true;
}

}  // namespace fieldproof::os
