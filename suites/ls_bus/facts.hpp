// Facts of `table` vectors of the LS Bus against the tables in src/ls_bus. Each has "model":
// "inverter" and one of
//   {"first": "0000", "last": "0003", "write": false}   each of these parameters exists, and has
//                                                       that right
//   {"first": "1000", "last": "11FF", "exists": false}  none of them exists
//   {"max_words": 8}
//   {"max_frame": 44}
//   {"error": "FE"}                                     the emulated inverter knows this code
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "src/base/result.hpp"

namespace fieldproof::ls_bus_suite {

/// The error says what the table holds instead.
Status check_fact(const nlohmann::json& facts);

}  // namespace fieldproof::ls_bus_suite
