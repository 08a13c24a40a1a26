// The channels of an Ethernet module as their dialog sets them (FEnet EN 7.3.2, table 7-3): each
// has a driver, a partner and a port of its own (7.1.1: each communicates by another protocol).
//
//   "channels": [{"channel": 2, "protocol": "modbus-tcp", "partner": "192.0.2.7"},
//                {"channel": 3, "transport": "udp"}]
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "src/base/burst.hpp"
#include "src/base/result.hpp"

namespace fieldproof::p2p {

struct P2pChannel {
  unsigned number = 0;     // 1 to 3
  std::string protocol{};  // of its driver; empty: that of the module
  std::string partner{};   // its address; empty: whoever is there
  unsigned port = 0;       // where it listens; 0: where its service has its port
  Transport transport = Transport::tcp;
};

/// `channels` of `p2p`; empty where there are none. An entry without a partner has that of `p2p`.
/// Errors name the entry and the key.
Result<std::vector<P2pChannel>> parse_p2p_channels(const nlohmann::json& p2p, unsigned highest);

}  // namespace fieldproof::p2p
