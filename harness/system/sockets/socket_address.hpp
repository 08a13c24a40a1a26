// HOST:PORT as people write it, and as sockets want it.
#pragma once

#include <netdb.h>
#include <sys/socket.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "src/base/result.hpp"

namespace fieldproof::os {

/// "HOST:PORT" taken apart.
struct SocketName {
  std::string host;                   // a name or an address; IPv6 without its brackets
  std::optional<std::uint16_t> port;  // nothing: none was written
};

/// Reads "HOST", "HOST:PORT" or ":PORT"; an IPv6 address stands in brackets. The error is the cause
/// alone: "'70000' is no port; write a number up to 65535".
Result<SocketName> parse_socket_name(const std::string& text);
/// As it is read: "[::1]:502".
std::string to_string(const SocketName& name);

/// An address of the kernel, of either family.
struct SocketAddress {
  sockaddr_storage storage{};
  socklen_t size = sizeof(sockaddr_storage);

  sockaddr* get() { return reinterpret_cast<sockaddr*>(&storage); }
  const sockaddr* get() const { return reinterpret_cast<const sockaddr*>(&storage); }
  std::uint16_t port() const;
  void set_port(std::uint16_t port);
};
/// "127.0.0.1:40312", "[::1]:502".
std::string to_string(const SocketAddress& address);
/// The bench's own end of a socket.
SocketAddress local_address(int fd);

struct AddressInfoDeleter {
  void operator()(addrinfo* list) const { ::freeaddrinfo(list); }
};
using AddressInfo = std::unique_ptr<addrinfo, AddressInfoDeleter>;

/// The addresses of a host, with the port (0 where none is written); `passive` for listening, where
/// an empty host stands for all addresses of this computer. The error is the cause alone: "cannot
/// find host 'plc' (Name or service not known); write its address".
Result<AddressInfo> resolve(const SocketName& name, bool passive);
/// The same of "HOST:PORT", where the port must be written.
Result<AddressInfo> resolve(const std::string& host_and_port, bool passive);

}  // namespace fieldproof::os
