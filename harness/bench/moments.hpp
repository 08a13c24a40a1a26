// A case may look at what is so for milliseconds, as an axis under way. Behind a request that takes
// longer than that, such looks are passed over, and those behind them still say something.
#pragma once

#include "harness/exchange/prepared_case.hpp"
#include "harness/protocol.hpp"

namespace fieldproof::bench {

/// Looks that no request hits.
struct Moments {
  std::vector<std::size_t> steps;  // of the case: their indices
  bool acted_in = false;  // something is done at such a moment: all that follows depends on it
  bool alone = false;     // the case looks at nothing else
};

Moments moments_of(const exchange::PreparedCase& prepared, const harness::Protocol& protocol);

}  // namespace fieldproof::bench
