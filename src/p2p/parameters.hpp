// A P2P parameter: up to 32 blocks, read from JSON and checked as XG5000 checks them (Cnet EN and
// KO 6.2.1-6.2.4, Cnet KO 6.3.2).
//
//   {"parameter": 1, "channel": 1, "link": true,
//    "blocks": [{"block": 0, "channel": 1, "function": "read", "flag": "%MX00000",
//                "command": "single", "type": "word",
//                "read": "%MW100", "save": "%MW200", "station": 2}, ...]}
//
// `flag` is a bit or a clock (condition.hpp). Stations are 0-255 (Cnet EN 11.1.4 'Available range:
// 0~255'; the 0-31 of Cnet KO 6.3.2 is what one line carries). Parameter 1 has channels 1 and 2; 2
// and 3 are modules of one channel (6.2.3), which may be called 1 or 2 (Cnet KO 11.2.2 sets channel
// 2 of an XBL-C21A).
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "src/base/burst.hpp"
#include "src/base/result.hpp"
#include "src/p2p/block.hpp"
#include "src/p2p/channels.hpp"

namespace fieldproof::p2p {

class P2pDriver;

/// What differs between the Cnet channels and those of an Ethernet module.
struct P2pRules {
  bool network = false;   // parameters 1 to 3 each have all channels; `email`, `partner`, `port`
                          // and `transport` are keys of p2p
  unsigned channels = 2;  // 1 to so many
  unsigned station = 0;   // of a block that gives none
};
/// FEnet EN 7.1.1: three channels. A block gives no station; Modbus TCP carries it as the unit.
constexpr P2pRules network_p2p_rules() { return {.network = true, .channels = 3, .station = 1}; }

struct P2pParameters {
  unsigned parameter = 1;                // 1-3
  unsigned channel = 1;                  // the one that an endpoint leads to
  bool link = true;                      // link enable (Cnet EN 6.2.6)
  std::vector<P2pBlock> blocks{};        // in the order of their numbers
  bool network = false;                  // of an Ethernet module
  std::string partner{};                 // its address; empty: whoever is there
  unsigned port = 0;                     // where it listens; 0: where the service has its port
  Transport transport = Transport::tcp;  // FEnet EN table 7-3
  std::vector<P2pChannel> channels{};    // that have settings of their own
  bool email = false;                    // p2p has e-mail settings (src/email/settings.hpp)

  /// Its own settings, else those of all channels.
  P2pChannel settings_of(unsigned channel_number) const;
};

/// What holds whatever the driver is. Errors name the block and the key: "cannot set up P2P block
/// 3: ...".
Result<P2pParameters> parse_p2p_parameters(const nlohmann::json& p2p, const plc::PlcModel& model,
                                           const P2pRules& rules = {});

/// What the driver of `channel` adds: user frames are for the driver user-frames alone, which has
/// nothing else (6.2.3); and P2pDriver::check of each block of that channel.
Status check_p2p_driver(const P2pParameters& parameters, unsigned channel, const P2pDriver& driver,
                        const plc::PlcModel& model);

}  // namespace fieldproof::p2p
