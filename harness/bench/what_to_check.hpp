// What an engineer looks at when a device says nothing.
#pragma once

#include <string>

#include "harness/exchange/sanity.hpp"

namespace fieldproof::bench {

/// Of a device that should answer; `sign` is not alive. A line has speed, format and polarity; a
/// network has an address, a port, a firewall, a table of hosts and a number of connections.
std::string why_silent(const exchange::Channel& device, exchange::Sign sign);

/// Of a device that should ask.
std::string why_nothing_is_asked(const exchange::Channel& device);

}  // namespace fieldproof::bench
