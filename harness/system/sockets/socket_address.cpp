#include "harness/system/sockets/socket_address.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>

#include <algorithm>
#include <array>

namespace fieldproof::os {

namespace {

bool is_port(const std::string& text) {
  return !text.empty() && text.size() <= 5 &&
         std::ranges::all_of(text, [](char c) { return c >= '0' && c <= '9'; }) &&
         std::stoi(text) <= 65535;
}

in_port_t& port_field(sockaddr_storage& address) {
  return address.ss_family == AF_INET6 ? reinterpret_cast<sockaddr_in6&>(address).sin6_port
                                       : reinterpret_cast<sockaddr_in&>(address).sin_port;
}

}  // namespace

Result<SocketName> parse_socket_name(const std::string& text) {
  SocketName name;
  std::size_t colon = text.rfind(':');
  if (text.starts_with('[')) {
    const std::size_t end = text.find(']');
    const bool whole = end + 1 == text.size();
    if (end == std::string::npos || (!whole && text[end + 1] != ':'))
      return fail("the brackets of '" + text + "' do not hold an address; write [IPV6]:PORT");
    name.host = text.substr(1, end - 1);
    colon = whole ? std::string::npos : end + 1;
  } else {
    name.host = text.substr(0, colon);
    if (name.host.find(':') != std::string::npos)
      return fail("'" + text +
                  "' has several colons; write an IPv6 address in brackets: [::1]:502");
  }
  if (colon == std::string::npos) return name;
  const std::string port = text.substr(colon + 1);
  if (port.empty()) return fail("there is no port; write HOST:PORT");
  if (!is_port(port)) return fail("'" + port + "' is no port; write a number up to 65535");
  name.port = static_cast<std::uint16_t>(std::stoi(port));
  return name;
}

std::string to_string(const SocketName& name) {
  std::string text = name.host.find(':') == std::string::npos ? name.host : '[' + name.host + ']';
  return name.port ? text + ':' + std::to_string(*name.port) : text;
}

std::uint16_t SocketAddress::port() const {
  return ntohs(port_field(const_cast<sockaddr_storage&>(storage)));
}

void SocketAddress::set_port(std::uint16_t port) { port_field(storage) = htons(port); }

std::string to_string(const SocketAddress& address) {
  std::array<char, INET6_ADDRSTRLEN> text{};
  const bool six = address.storage.ss_family == AF_INET6;
  const void* bytes = six ? static_cast<const void*>(
                                &reinterpret_cast<const sockaddr_in6&>(address.storage).sin6_addr)
                          : static_cast<const void*>(
                                &reinterpret_cast<const sockaddr_in&>(address.storage).sin_addr);
  ::inet_ntop(six ? AF_INET6 : AF_INET, bytes, text.data(), text.size());
  return to_string(SocketName{text.data(), address.port()});
}

SocketAddress local_address(int fd) {
  SocketAddress address;
  ::getsockname(fd, address.get(), &address.size);
  return address;
}

Result<AddressInfo> resolve(const SocketName& name, bool passive) {
  if (name.host.empty() && !passive) return fail("there is no host; write HOST:PORT");
  addrinfo hints{};
  hints.ai_family = AF_UNSPEC;
  hints.ai_socktype = SOCK_STREAM;
  hints.ai_flags = AI_NUMERICSERV | (passive ? AI_PASSIVE : 0);
  addrinfo* list = nullptr;
  const std::string port = std::to_string(name.port.value_or(0));
  if (const int error = ::getaddrinfo(name.host.empty() ? nullptr : name.host.c_str(), port.c_str(),
                                      &hints, &list);
      error != 0) {
    return fail("cannot find host '" + name.host + "' (" + ::gai_strerror(error) +
                "); write its address");
  }
  return AddressInfo(list);
}

Result<AddressInfo> resolve(const std::string& host_and_port, bool passive) {
  const Result<SocketName> name = parse_socket_name(host_and_port);
  if (!name) return name.error();
  if (!name->port) return fail("there is no port; write HOST:PORT");
  return resolve(*name, passive);
}

}  // namespace fieldproof::os
