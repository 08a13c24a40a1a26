// A socket on which a hosted device listens.
#pragma once

#include <optional>

#include "harness/system/sockets/socket_listen.hpp"
#include "src/base/burst.hpp"

namespace fieldproof::hosting {

struct Listening {
  os::UniqueFd socket;
  os::SocketName name;  // with the port that it has
};

/// The address of --tcp and --udp: "HOST:PORT", "PORT" or ":PORT" (loopback), and "HOST" where
/// there is a `usual_port`. Errors are the user's.
Result<os::SocketName> read_address(const std::string& text,
                                    std::optional<std::uint16_t> usual_port);
/// Listens there; errors are those of read_address and of listen_socket.
Result<Listening> listen_on(const std::string& address, Transport transport,
                            std::optional<std::uint16_t> usual_port);

}  // namespace fieldproof::hosting
