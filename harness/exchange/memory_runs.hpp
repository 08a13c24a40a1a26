// Words of memory that follow each other, so that a device is asked once for many of them.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "harness/protocol.hpp"

namespace fieldproof::exchange {

/// Address and hex digits, as given.memory has them.
using MemoryValues = std::vector<std::pair<std::string, std::string>>;

/// A value of one address that fills the words behind it, too, and the single ones that it is made
/// of.
struct MemoryRun {
  std::string address, hex;
  MemoryValues parts;
};

/// The same values in the same order, single words joined where the protocol has them all at one
/// place (Protocol::places).
std::vector<MemoryRun> runs_of(const MemoryValues& values, const harness::Protocol& protocol);

}  // namespace fieldproof::exchange
