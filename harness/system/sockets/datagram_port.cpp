#include "harness/system/sockets/datagram_port.hpp"

#include <sys/socket.h>

#include <array>
#include <cerrno>

#include "harness/system/system_calls.hpp"

namespace fieldproof::os {

std::optional<Arrival> DatagramPort::read() {
  if (!fd_) return std::nullopt;
  if (std::exchange(refused_, false)) return Arrival{LinkEvent::reset};
  std::array<Byte, 65'536> buffer;
  ssize_t n = 0;
  do {
    n = ::recv(fd_.get(), buffer.data(), buffer.size(), 0);
  } while (n < 0 && errno == EINTR);
  if (n >= 0) return Arrival{LinkEvent::datagram, Bytes(buffer.begin(), buffer.begin() + n)};
  if (errno == ECONNREFUSED) return Arrival{LinkEvent::reset};
  return std::nullopt;
}

Status DatagramPort::write(ByteView bytes) {
  for (;;) {
    if (::send(fd_.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL) >= 0) return ok();
    if (errno == ECONNREFUSED)
      refused_ = true;  // what an earlier one met; this one has not gone out
    else if (errno == EMSGSIZE)
      return fail("a datagram holds at most 65507 bytes");
    else if (errno != EINTR)
      return fail(errno_text(errno));
  }
}

}  // namespace fieldproof::os
