// Sockets that wait for others.
#pragma once

#include "harness/system/sockets/socket_address.hpp"
#include "harness/system/unique_fd.hpp"

namespace fieldproof::os {

/// A non-blocking socket that is bound, and listens where `type` is SOCK_STREAM; SOCK_DGRAM takes
/// datagrams. An empty host is every address of this computer; port 0, or none, any that is free.
/// Errors: "cannot listen on 127.0.0.1:502: ports below 1024 are for root; ...".
Result<UniqueFd> listen_socket(const SocketName& name, int type);

/// The next connection, non-blocking and without delay of small packets; none where nobody waits.
/// `from` becomes the address that it came from.
UniqueFd accept_socket(int listener, SocketAddress& from);

}  // namespace fieldproof::os
