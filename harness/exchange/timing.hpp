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
  Duration pause = 2 * quiet;      // what comes after less than this goes on
};

/// How long a whole frame may be on its way at most: twice its characters, and a second for pauses
/// between them. Bytes that trickle in for longer are no frame.
inline Duration longest_reply(std::size_t longest_frame, Duration character_time) {
  return 2 * character_time * static_cast<Duration::rep>(longest_frame) + 1s;
}

/// How exactly a client keeps its time-out is not printed (p2p/time-out): half a step of its
/// setting.
inline constexpr Duration near_the_time_out = 50ms;

/// More than any exchange of these protocols comes to: the device floods.
inline constexpr std::size_t flood_limit = 16'384;

}  // namespace fieldproof::exchange
