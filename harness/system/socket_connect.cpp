#include "harness/system/socket_connect.hpp"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>

#include "harness/system/fd_link.hpp"
#include "harness/system/interrupt.hpp"
#include "harness/system/socket_address.hpp"
#include "harness/system/system_calls.hpp"

namespace fieldproof::os {

namespace {

constexpr int connect_limit_ms = 3000;

/// 0, or the errno that says why not.
int finish_connect(int fd) {
  std::array<pollfd, 2> fds{pollfd{fd, POLLOUT, 0}, pollfd{interrupt_fd(), POLLIN, 0}};
  const int ready = ::poll(fds.data(), fds.size(), connect_limit_ms);
  if (interrupted()) return EINTR;
  if (ready == 0) return ETIMEDOUT;
  if (ready < 0) return errno;
  int error = 0;
  socklen_t size = sizeof error;
  return ::getsockopt(fd, SOL_SOCKET, SO_ERROR, &error, &size) == 0 ? error : errno;
}

int connect_to(const addrinfo& address, int type, UniqueFd& fd) {
  fd.reset(::socket(address.ai_family, type | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  if (!fd) return errno;
  if (::connect(fd.get(), address.ai_addr, address.ai_addrlen) == 0) return 0;
  return errno == EINPROGRESS || errno == EINTR ? finish_connect(fd.get()) : errno;
}

std::string advice(int error) {
  switch (error) {
    case ECONNREFUSED:
      return "nothing listens there; start the device or serial server, or correct the port";
    case ETIMEDOUT:
      return "no answer within 3 s; see that the host is on and that no firewall drops the "
             "connection";
    default: return errno_text(error) + "; correct the address";
  }
}

}  // namespace

Result<UniqueFd> connect_socket(const std::string& where, int type) {
  const std::string start = "cannot connect to " + where + ": ";
  const Result<AddressInfo> list = resolve(where, false);
  if (!list) return fail(start + list.error().message);
  UniqueFd fd;
  int error = 0;
  for (const addrinfo* one = list->get(); one; one = one->ai_next) {
    error = connect_to(*one, type, fd);
    if (error == 0 || interrupted()) break;
  }
  if (interrupted()) return interrupted_error("connect to", where);
  if (error != 0) return fail(start + advice(error));
  const int yes = 1;
  if (type == SOCK_STREAM) ::setsockopt(fd.get(), IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
  return fd;
}

}  // namespace fieldproof::os
