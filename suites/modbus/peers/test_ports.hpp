// Ports of this computer for the programs of the tests.
#pragma once

#include <poll.h>

#include <chrono>

#include "harness/system/sockets/test_sockets.hpp"

namespace fieldproof::modbus_peers {

/// That nobody listens on, a moment ago.
inline std::uint16_t free_port() { return os::test::port_of(os::test::bound(SOCK_STREAM)); }

/// Until somebody takes a connection; false: nobody does within a minute.
inline bool is_served(std::uint16_t port) {
  const sockaddr_in address = os::test::loopback(port);
  const auto until = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  while (std::chrono::steady_clock::now() < until) {
    const os::UniqueFd fd(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
    if (::connect(fd.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0)
      return true;
    ::poll(nullptr, 0, 10);
  }
  return false;
}

}  // namespace fieldproof::modbus_peers
