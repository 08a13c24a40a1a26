// The high-speed link parameter of one station (FEnet EN 8.1, 8.2.2).
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "src/base/result.hpp"
#include "src/base/time.hpp"
#include "src/plc/address.hpp"

namespace fieldproof::hs_link {

constexpr unsigned most_blocks = 64, most_one_way = 32, most_words = 200, last_station = 63;
constexpr Duration shortest_period = 20ms, longest_period = 10s;

/// One registered item: words that are sent, or taken and saved.
struct Block {
  bool sends = false;
  unsigned station = 0;  // that sends it
  unsigned number = 0;
  plc::DeviceAddress area{};  // its first word
  unsigned words = 1;
};

struct Parameter {
  unsigned link = 1;  // 1 or 2: where its flags are
  unsigned station = 0;
  Duration period = 200ms;
  bool enabled = true;
  std::vector<Block> blocks{};  // the place of a block is the k of its flags
};

/// The object "hs_link" of given.config of that station (vectors/README.md). Errors name what is
/// wrong, and the limit.
Result<Parameter> read_parameter(const nlohmann::json& object, unsigned station,
                                 const plc::PlcModel& model);

}  // namespace fieldproof::hs_link
