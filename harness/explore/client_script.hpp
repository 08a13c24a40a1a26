// What is done to a device that asks, as the steps of a case, and what our own device did there.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "harness/exchange/transcript.hpp"
#include "harness/explore/client_pool.hpp"
#include "harness/vectors/case.hpp"

namespace fieldproof::explore {

/// As a device has it: configuration and memory.
struct ClientSetUp {
  nlohmann::json config;               // without blocks
  std::vector<nlohmann::json> blocks;  // in the order of their numbers
  std::uint64_t data = 0;              // seed of the memory
};

/// What is done once, and what comes of it.
struct Stimulus {
  std::string action;               // `do`; else the flags of these blocks rise at once:
  std::vector<std::size_t> fired;   // in block order
  std::vector<std::string> faults;  // of the partner, for each; "": it answers well
  std::uint64_t data = 0;           // seed of what is read and written
};

/// A case whose frames and values are still open.
struct ClientScript {
  vectors::Case one;
  std::vector<std::size_t> ends;  // of each stimulus: the first step behind it
};

/// `results`: where else to look than at the memory of the blocks.
ClientScript client_script(const ClientSetUp& set_up, const std::vector<Stimulus>& stimuli,
                           const harness::Protocol& protocol,
                           const std::map<BlockNumber, std::set<Watched>>& results);

/// Puts what our own device did where it is expected; `open` are bytes of a request that any device
/// may choose. What was not asked for is waited for no more: `unasked` tells that there was such.
/// False: something came that no step was waiting for, before an answer was out, or long after it;
/// or a step could not be done.
bool fill(vectors::Case& one, const exchange::Transcript& transcript,
          const std::set<std::size_t>& open, bool& unasked);

}  // namespace fieldproof::explore
