// What the first byte of an input chooses, and the vectors that inputs are made from.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "harness/vectors/case.hpp"
#include "suites/protocols.hpp"

namespace fieldproof::fuzz {

/// By the number of its place in the table.
const harness::Protocol& protocol_of(Byte number);
std::optional<Byte> number_of(std::string_view protocol);
Bytes behind(Byte number, ByteView rest);

/// All cases with their literal bytes, read once.
const std::vector<vectors::Case>& cases_of_vectors();
/// The literal bytes of a step; a digit that may be any is 0.
std::vector<Bytes> wires_of(const vectors::Step& step);

}  // namespace fieldproof::fuzz
