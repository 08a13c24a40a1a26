// The way of XG5000 to a distant PLC (FEnet EN chapter 9), as it is set up: no manual prints a
// frame of it.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "src/base/result.hpp"

namespace fieldproof::xgt_fenet {

/// Of its server and of its client: over TCP (tables 2-6, 2-7).
constexpr std::uint16_t remote_port = 2002;
constexpr unsigned remote_channels = 1;

/// One network that is crossed: the module by which a PLC leads into it, and on an Ethernet whom it
/// leads to (9.2.1, 9.2.2).
struct RemoteStage {
  std::string network;  // "fenet"
  unsigned base = 0, slot = 0;
  std::string ip{};
};

/// Of a list of remote 1 and, where the way goes on, remote 2:
/// [{"network": "fenet", "base": 0, "slot": 2, "ip": "192.168.91.188"}, ...]. Errors name the key.
Result<std::vector<RemoteStage>> read_remote(const nlohmann::json& stages);

}  // namespace fieldproof::xgt_fenet
