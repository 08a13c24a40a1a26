// HOST:PORT as sockets want it.
#pragma once

#include <netdb.h>

#include <memory>
#include <string>

#include "src/base/result.hpp"

namespace fieldproof::os {

struct AddressInfoDeleter {
  void operator()(addrinfo* list) const { ::freeaddrinfo(list); }
};
using AddressInfo = std::unique_ptr<addrinfo, AddressInfoDeleter>;

/// The TCP addresses of "HOST:PORT" or "[IPV6]:PORT"; `passive` for listening, where HOST may be
/// empty (all). The error is the cause alone: "there is no port; write HOST:PORT".
Result<AddressInfo> resolve(const std::string& host_and_port, bool passive);

}  // namespace fieldproof::os
