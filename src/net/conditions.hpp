// How well a simulated network carries what is sent. Chances are 0 to 1; the seed decides, so that
// equal seeds give equal runs.
#pragma once

#include <cstdint>
#include <random>

#include "src/base/time.hpp"

namespace fieldproof::net {

struct Conditions {
  std::uint64_t seed = 1;
  Duration delay{};   // each way
  Duration jitter{};  // up to so much more, each time; the bytes of a connection keep their order

  /// Connections. A segment is cut behind each byte with chance `cut`; what arrives at the moment
  /// of the piece before it (behind which it had to wait, or was sent) is one with it with chance
  /// `join`.
  double cut = 0, join = 0;

  /// Datagrams: lost, doubled, or late by `lateness`, so that the next overtakes it.
  double lost = 0, doubled = 0, late = 0;
  Duration lateness = 10ms;
};

/// Decides by the seed. The standard's distributions differ from library to library; this does not.
class Chance {
 public:
  explicit Chance(std::uint64_t seed) : generator_(seed) {}

  bool happens(double chance) { return chance > 0 && unit() < chance; }
  /// Zero to `most`.
  Duration up_to(Duration most) {
    return most > Duration::zero()
               ? Duration(static_cast<Duration::rep>(unit() * static_cast<double>(most.count())))
               : Duration::zero();
  }

 private:
  double unit() { return static_cast<double>(generator_() >> 11) * 0x1p-53; }

  std::mt19937_64 generator_;
};

}  // namespace fieldproof::net
