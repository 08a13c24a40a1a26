#include "harness/system/sockets/socket_connect.hpp"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include "harness/system/fd_link.hpp"
#include "harness/system/interrupt.hpp"
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

/// 0: it stands, or is on its way.
int begin_connect(const sockaddr* address, socklen_t size, int type, UniqueFd& fd) {
  fd.reset(::socket(address->sa_family, type | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  if (!fd) return errno;
  const int yes = 1;
  if (type == SOCK_STREAM) ::setsockopt(fd.get(), IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
  if (::connect(fd.get(), address, size) == 0 || errno == EINPROGRESS || errno == EINTR) return 0;
  return errno;
}

int connect_to(const SocketAddress& address, int type, UniqueFd& fd) {
  const int error = begin_connect(address.get(), address.size, type, fd);
  return error == 0 ? finish_connect(fd.get()) : error;
}

std::string connect_advice(int error) {
  switch (error) {
    case ETIMEDOUT:
      return "no answer within 3 s; see that the host is on and that no firewall drops the "
             "connection";
    case EHOSTUNREACH:
    case ENETUNREACH:
      return errno_text(error) +
             "; see that this computer is on the device's network, or correct the address";
    default: return errno_text(error) + "; correct the address";
  }
}

/// A connection that ends before it is known to stand was refused, too.
bool is_refusal(int error) { return error == ECONNREFUSED || error == ECONNRESET; }

}  // namespace

Result<RemoteHost> RemoteHost::find(const std::string& host) {
  const Result<AddressInfo> list = resolve(SocketName{host, std::nullopt}, false);
  if (!list) return list.error();
  RemoteHost found;
  found.host_ = host;
  for (const addrinfo* one = list->get(); one; one = one->ai_next) {
    SocketAddress& address = found.addresses_.emplace_back();
    std::memcpy(&address.storage, one->ai_addr, one->ai_addrlen);
    address.size = one->ai_addrlen;
  }
  return found;
}

Result<UniqueFd> RemoteHost::connect(std::uint16_t port, int type) {
  const std::string where = to_string(SocketName{host_, port});
  if (port == 0)
    return fail("cannot connect to " + where + ": 0 is no port; write a number from 1 to 65535");
  UniqueFd fd;
  int error = EADDRNOTAVAIL;
  for (auto one = addresses_.begin(); one != addresses_.end() && error != 0; ++one) {
    one->set_port(port);
    error = connect_to(*one, type, fd);
    if (interrupted()) return interrupted_error("connect to", where);
    if (error == 0) std::rotate(addresses_.begin(), one, one + 1);  // asked first from now on
  }
  nobody_listens_ = error == ECONNREFUSED;
  if (is_refusal(error)) return UniqueFd();
  if (error != 0) return fail("cannot connect to " + where + ": " + connect_advice(error));
  return fd;
}

UniqueFd begin_connecting(const SocketName& name, int type) {
  const Result<AddressInfo> list = resolve(name, false);
  UniqueFd fd;
  if (!list || begin_connect((*list)->ai_addr, (*list)->ai_addrlen, type, fd) != 0)
    return UniqueFd();
  return fd;
}

Result<UniqueFd> connect_socket(const std::string& where, int type) {
  const std::string start = "cannot connect to " + where + ": ";
  const Result<SocketName> name = parse_socket_name(where);
  if (!name) return fail(start + name.error().message);
  if (!name->port) return fail(start + "there is no port; write HOST:PORT");
  Result<RemoteHost> host = RemoteHost::find(name->host);
  if (!host) return fail(start + host.error().message);
  Result<UniqueFd> fd = host->connect(*name->port, type);
  if (fd && !*fd) return fail(start + refused_advice);
  return fd;
}

bool takes_another_client(const std::string& where) {
  constexpr int says_no_within_ms = 300;  // "Port already in use", and the end
  const Result<UniqueFd> fd = connect_socket(where, SOCK_STREAM);
  if (!fd) return false;
  pollfd one{fd->get(), POLLIN, 0};
  while (::poll(&one, 1, says_no_within_ms) == 1) {
    char words[256];
    if (::recv(fd->get(), words, sizeof words, 0) <= 0) return false;
  }
  return !interrupted();
}

Duration round_trip(int fd) {
  tcp_info info{};
  socklen_t size = sizeof info;
  if (::getsockopt(fd, IPPROTO_TCP, TCP_INFO, &info, &size) != 0) return {};
  return std::chrono::microseconds(info.tcpi_rtt);
}

}  // namespace fieldproof::os
