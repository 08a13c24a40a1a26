// Facts of the manual about the high-speed link, checked against the tables of src/hs_link.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "src/base/result.hpp"

namespace fieldproof::hs_link_suite {

/// {"hs_link": 1, "flag": "mod", "block": 55, "mk": "L00097", "iec": "%LX151"}, mk or iec or both;
/// {"parameter": {...}, "accepted": false}, an hs_link object of given.config. The error says what
/// the table holds instead.
Status check_fact(const nlohmann::json& facts);

}  // namespace fieldproof::hs_link_suite
