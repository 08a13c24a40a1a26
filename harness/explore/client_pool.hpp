// What the P2P blocks of the vectors let a device ask as client, and where it shows what came of
// it.
#pragma once

#include <cstddef>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "harness/notation/notation.hpp"
#include "harness/protocol.hpp"
#include "harness/vectors/case.hpp"

namespace fieldproof::explore {

/// Parameter and block.
using BlockNumber = std::pair<int, int>;
/// Address and hex digits there.
using Watched = std::pair<std::string, std::size_t>;

struct ClientPool {
  struct Group {
    nlohmann::json config;               // given.config without blocks
    std::vector<nlohmann::json> blocks;  // with every default (exchange::p2p_blocks)
  };
  /// Blocks that can stand beside each other in a device: those of the same other configuration.
  std::vector<Group> groups;
  /// Where vectors look at the results of a block of this number.
  std::map<BlockNumber, std::set<Watched>> results;
  /// Bits that vectors take as condition flags.
  std::vector<std::string> flags;
  /// Bytes of a request, by offset, that most vectors leave open: a device numbers its requests as
  /// it likes.
  std::set<std::size_t> open;
};

/// Of blocks that read or write on the one channel of the case, by a flag, on `model`. Without
/// blocks where no vector has such.
ClientPool client_pool(const std::vector<vectors::Case>& cases, const harness::Protocol& protocol,
                       std::string_view model);

BlockNumber number_of(const nlohmann::json& block);

/// The memory of its own that a block reads from or saves to: an address for each variable.
std::vector<Watched> own_memory(const nlohmann::json& block);

/// All bytes as they are, but for those that are open.
notation::Notation request_notation(ByteView frame, const std::set<std::size_t>& open);

}  // namespace fieldproof::explore
