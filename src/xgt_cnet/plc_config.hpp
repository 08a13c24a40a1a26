// The JSON of an emulated PLC that is XGT Cnet server: the basic parameters of a port.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string_view>

#include "src/base/result.hpp"
#include "src/plc/port_config.hpp"

namespace fieldproof::xgt_cnet {

/// The configuration in `given.config` of a vector (vectors/README.md), and
/// inter_character_floor_ms. Values are numbers, booleans or their text. Keys for others
/// (bench_line, model, neighbours, protocol) are passed over; the error for an unknown key lists
/// those there are.
Result<plc::PortConfig> parse_plc_config(std::string_view model, const nlohmann::json& config);

}  // namespace fieldproof::xgt_cnet
