#include "harness/system/sockets/socket_listen.hpp"

#include <netinet/in.h>
#include <netinet/tcp.h>

#include <cerrno>

#include "harness/system/system_calls.hpp"

namespace fieldproof::os {

namespace {

/// As many as the kernel queues by itself; a device that takes fewer says so itself.
constexpr int waiting_connections = 128;

/// 0, or the errno that says why not.
int bind_to(const addrinfo& address, int type, UniqueFd& fd) {
  fd.reset(::socket(address.ai_family, type | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  if (!fd) return errno;
  const int yes = 1;
  // Connections of a server that has just ended do not keep its port. (Datagram servers would
  // share it.)
  if (type == SOCK_STREAM) ::setsockopt(fd.get(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  if (::bind(fd.get(), address.ai_addr, address.ai_addrlen) != 0) return errno;
  return type != SOCK_STREAM || ::listen(fd.get(), waiting_connections) == 0 ? 0 : errno;
}

/// 502 is 10502.
std::uint16_t unprivileged(std::uint16_t port) { return static_cast<std::uint16_t>(10'000 + port); }

std::string listen_advice(int error, const SocketName& name) {
  switch (error) {
    case EADDRINUSE:
      return "the port is in use; end the program that has it, or choose another port";
    case EACCES:
      return "ports below 1024 are for root; choose one from 1024 up, such as " +
             to_string(SocketName{name.host, unprivileged(name.port.value_or(0))}) +
             ", or run it as root";
    case EADDRNOTAVAIL:
      return "this is no address of this computer; choose 127.0.0.1 (for programs here alone), "
             "0.0.0.0 (all addresses) or one that `ip address` lists";
    default: return errno_text(error) + "; choose another port or address";
  }
}

}  // namespace

Result<UniqueFd> listen_socket(const SocketName& name, int type) {
  const std::string start = "cannot listen on " + to_string(name) + ": ";
  const Result<AddressInfo> list = resolve(name, true);
  if (!list) return fail(start + list.error().message);
  UniqueFd fd;
  int error = EADDRNOTAVAIL;
  for (const addrinfo* one = list->get(); one && error != 0; one = one->ai_next)
    error = bind_to(*one, type, fd);
  if (error != 0) return fail(start + listen_advice(error, name));
  return fd;
}

UniqueFd accept_socket(int listener, SocketAddress& from) {
  from.size = sizeof from.storage;
  UniqueFd fd(::accept4(listener, from.get(), &from.size, SOCK_CLOEXEC | SOCK_NONBLOCK));
  const int yes = 1;
  if (fd) ::setsockopt(fd.get(), IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
  return fd;
}

}  // namespace fieldproof::os
