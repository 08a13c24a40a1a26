// Parameters of an emulated PLC that speaks XGT Cnet, and their JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "src/base/result.hpp"
#include "src/plc/port_config.hpp"

namespace fieldproof {

/// A P2P block as it is entered: device names.
struct P2pConfig {
  std::string flag{};      // "%MX00000"
  std::string read{};      // in the partner
  std::string save{};
  unsigned station = 0;  // of the partner, 0-255
  unsigned count = 1;    // values, at most 60 words

  bool operator==(const P2pConfig&) const = default;
};

struct PlcConfig : PortConfig {
  unsigned time_out = 1;  // of the client: (time_out + 1) * 100 ms
  std::vector<P2pConfig> p2p{};

  bool operator==(const PlcConfig&) const = default;
};

/// The configuration in `given.config` of a vector (vectors/README.md), and inter_character_floor_ms and time_out (000 4.3.1).
/// Values are numbers, booleans or their text. Keys for others (bench_line, model, neighbours, protocol) are passed over;
/// the error for an unknown key lists those there are.
Result<PlcConfig> parse_plc_config(std::string_view model, const nlohmann::json& config);

}  // namespace fieldproof
