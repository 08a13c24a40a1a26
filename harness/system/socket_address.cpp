#include "harness/system/socket_address.hpp"

#include <algorithm>

namespace fieldproof::os {

Result<AddressInfo> resolve(const std::string& host_and_port, bool passive) {
  const std::size_t colon = host_and_port.rfind(':');
  if (colon == std::string::npos || colon + 1 == host_and_port.size())
    return fail("there is no port; write HOST:PORT");
  std::string host = host_and_port.substr(0, colon);
  const std::string port = host_and_port.substr(colon + 1);
  if (port.size() > 5 || !std::ranges::all_of(port, [](char c) { return c >= '0' && c <= '9'; }) ||
      std::stoi(port) > 65535) {
    return fail("'" + port + "' is no port; write a number up to 65535");
  }
  if (host.size() > 1 && host.front() == '[' && host.back() == ']')
    host = host.substr(1, host.size() - 2);
  if (host.empty() && !passive) return fail("there is no host; write HOST:PORT");
  addrinfo hints{};
  hints.ai_family = AF_UNSPEC;
  hints.ai_socktype = SOCK_STREAM;
  hints.ai_flags = AI_NUMERICSERV | (passive ? AI_PASSIVE : 0);
  addrinfo* list = nullptr;
  if (const int error =
          ::getaddrinfo(host.empty() ? nullptr : host.c_str(), port.c_str(), &hints, &list);
      error != 0) {
    return fail("cannot find host '" + host + "' (" + ::gai_strerror(error) +
                "); write its address");
  }
  return AddressInfo(list);
}

}  // namespace fieldproof::os
