// The P2P blocks of a client case, as far as the bench must know them: when they ask, and what of
// their own they send.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace fieldproof::exchange {

/// The blocks of `given.config.p2p`, with every default written out (vectors/README.md). Empty
/// where there are none.
std::vector<nlohmann::json> p2p_blocks(const nlohmann::json& config);

/// Does a block of `given.config.p2p` ask over UDP?
bool asks_by_datagrams(const nlohmann::json& config);

/// The blocks of a list as it stands in `p2p.blocks` and in a profile's `prepared_blocks`.
std::vector<nlohmann::json> complete_blocks(const nlohmann::json& blocks,
                                            const nlohmann::json& p2p = nlohmann::json::object());

/// "%MX00000"; empty: a RECEIVE has none.
std::string flag_of(const nlohmann::json& block);
/// A block that asks at the pace of F90, F92, F93 (%FX.., XEC: _T20MS, ...): its flag is no device
/// that anyone sets.
bool runs_by_clock(const nlohmann::json& block);
/// Addresses of its own memory that a write sends.
std::vector<std::string> sent_addresses(const nlohmann::json& block);

/// "P2P 1 block 0: xgt-cnet client, read, continuous, 4 x word, on %MX00000, from %MW100 of station
/// 2, into %MW200".
std::string in_words(const nlohmann::json& block, std::string_view protocol);

/// What of `blocks` the blocks that an engineer has set up (`prepared`, complete_blocks()) do not
/// do, in words: one that is missing, or the keys in which one is another. Empty: nothing.
std::string not_prepared(const std::vector<nlohmann::json>& blocks,
                         const std::vector<nlohmann::json>& prepared, std::string_view protocol);
/// One of `prepared` that asks all the time although none of `blocks` has its place, in words.
std::string asks_uncalled(const std::vector<nlohmann::json>& blocks,
                          const std::vector<nlohmann::json>& prepared, std::string_view protocol);

}  // namespace fieldproof::exchange
