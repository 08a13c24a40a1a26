// Is the bench alone on a line that others can reach, too?
#pragma once

#include "harness/exchange/channel.hpp"
#include "harness/exchange/timing.hpp"
#include "src/base/result.hpp"

namespace fieldproof::exchange {

/// Listens for so long, and asks probes at moments that nobody can foresee: what somebody else asks
/// is answered to all, so that two benches that look on at once hear each other. What came that no
/// probe had asked for, at most a flood; empty: nothing.
Result<Bytes> unasked_bytes(const Channel& line, Duration watch, const ExchangeTiming& timing);

}  // namespace fieldproof::exchange
