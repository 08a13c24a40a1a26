// Facts of the X-NET manual, checked against the tables of src/xnet, src/xnet_network and
// src/xnet_motion.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "src/base/result.hpp"

namespace fieldproof::xnet_suite {

/// One of
///   {"series": "xd3", "first": "X10000", "last": "X10077", "type": 1, "quantity": 64,
///    "decimal": "4096~4159", "hex": "1000~103F"}
///   {"series": "xd3", "object": "X78", "exists": false}
///   {"model": "xd3", "instructions": 5}, {"model": "xd5", "last": "D59999"}
///   {"register": "present position", "axis": 2, "address": "SD2068", "words": 2, "initial": 0}
///   {"configuration": {"model": "xd3", ...}, "accepted": false}
///   {"instruction": "REG_READ ...", "model": "xd3", "accepted": false}
///   {"ip": "192.168.6.60", "net": 49320, "station": 1596}
///   {"cable": {"baud": 500000, "metres": 400}, "accepted": true}
///   {"servo": {"axis": 1, ...}, "axes": 10, "accepted": false}
///   {"characters": 15, "baud": 3000000, "bits": 11, "us": 55}
///   {"sampling": {"P7-03": 9}, "us": 33}
///   {"slots": {"P7-05": 20, "P7-07": 6000}, "frame": 30, "axis": 2, "from_us": 165, "to_us": 330,
///    "sends_from_us": 192.5, "sends_to_us": 302.5}, or whether they fit: "accepted": false
/// The error says what the table holds instead.
Status check_fact(const nlohmann::json& facts);

}  // namespace fieldproof::xnet_suite
