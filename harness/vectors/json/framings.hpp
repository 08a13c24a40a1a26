// One vector of a body that several protocols share, told apart again: one vector a framing.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace fieldproof::vectors {

/// The framings that a vector names: "modbus_rtu", ...; none where it is of one protocol alone.
std::vector<std::string> framings_of(const nlohmann::ordered_json& vector);

/// The id with this first part.
std::string framed_id(std::string_view id, std::string_view framing);

/// The vector as it is for one of its framings: under its id, with what differs there, with the
/// literal bytes of that framing alone. Throws Broken where it speaks of a framing that it does not
/// name.
nlohmann::ordered_json framed(const nlohmann::ordered_json& vector, const std::string& framing);

/// "xgt-cnet", for "xgt_cnet/rss/two_words".
std::string protocol_of(std::string_view id);

}  // namespace fieldproof::vectors
