// Words of memory that follow each other, so that a device is asked once for many of them.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "harness/protocol.hpp"

namespace fieldproof::exchange {

using MemoryValues = std::vector<harness::Protocol::Setting>;

/// Values that follow each other: the first address, and all their digits, set them in one.
using MemoryRun = std::span<const harness::Protocol::Setting>;
harness::Protocol::Setting as_one(MemoryRun run);

/// One run for each value.
std::vector<MemoryRun> each_of(const MemoryValues& values);
/// The same values in the same order, single words joined where the protocol has them all at one
/// place (Protocol::places). `values` must outlive them.
std::vector<MemoryRun> runs_of(const MemoryValues& values, const harness::Protocol& protocol);

}  // namespace fieldproof::exchange
