// How long the bench waits for what.
#pragma once

#include "src/base/time.hpp"

namespace fieldproof::exchange {

struct ExchangeTiming {
  Duration response_max = 500ms;  // the profile's limit: request's last byte to reply's first
  Duration late_watch =
      700ms;  // how much longer a late answer is waited for, so that it can be named
  Duration promised_silence = 1s;  // simulated time: each silence is waited out in full
  Duration quiet = 100ms;          // no further byte for so long: what is incomplete stays so
};

/// More than any exchange of these protocols comes to: the device floods.
inline constexpr std::size_t flood_limit = 16'384;

}  // namespace fieldproof::exchange
