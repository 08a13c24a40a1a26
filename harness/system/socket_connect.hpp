// A socket that is connected to HOST:PORT.
#pragma once

#include <string>

#include "harness/system/unique_fd.hpp"
#include "src/base/result.hpp"

namespace fieldproof::os {

/// `type`: SOCK_STREAM (TCP, without delay of small packets; at most 3 s) or SOCK_DGRAM (UDP:
/// nothing is sent yet). The socket is non-blocking. Errors: "cannot connect to plc:2004: nothing
/// listens there; start ...", or interrupted.
Result<UniqueFd> connect_socket(const std::string& where, int type);

}  // namespace fieldproof::os
