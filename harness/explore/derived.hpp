// `run --derived`: from each request of a vector that must be answered, those that a bad line makes
// of it. Each is answered as our own device answers it (decision explore/own-model), and the right
// request behind them as ever.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "harness/explore/oracle.hpp"
#include "harness/protocols.hpp"

namespace fieldproof::explore {

/// flipped: each bit; dropped, doubled: each byte; cut: after each byte; paused: before each byte,
/// below and above what ends a frame; noise: a byte before, and behind; joined: the frame twice. On
/// a network, where nothing protects a byte: split, into two segments, and joined.
std::vector<std::string> derivations(const harness::Protocol& protocol);

/// All of one derivation from a request, in the order of its bytes. `at_most` (0: all) of them, by
/// seed.
std::vector<Request> derived_from(const Request& request, const std::string& derivation,
                                  const harness::Protocol& protocol, int station,
                                  std::size_t at_most, std::uint64_t seed);

/// The cases that follow from these, in their order, a case for each vector and derivation:
/// "xgt_cnet/rss/two_words/derived/flipped" (and flipped_2, where they are many); only those whose
/// id is `wanted`. Of requests that differ in numbers alone the first counts. Errors: a model
/// cannot be made.
Result<std::vector<vectors::Case>> derived_cases(
    const std::vector<vectors::Case>& cases, const harness::Protocols& protocols,
    std::size_t at_most, std::uint64_t seed,
    const std::function<bool(const std::string& id)>& wanted);

}  // namespace fieldproof::explore
