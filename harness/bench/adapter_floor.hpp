// What the link itself can show: times below its floor prove nothing about the device.
#pragma once

#include <optional>
#include <string>

#include "reports/results/response_times.hpp"
#include "src/base/time.hpp"

namespace fieldproof::bench {

/// Answers to the probe, measured before the first case.
struct AdapterFloor {
  enum class Source {
    device,  // its fastest answer, or how far its answers scatter (but for one in twenty) where
             // that is more: the device's own time is in it, so that it bounds no silence inside a
             // reply
    loop,  // an emulator answers at once over the same kind of link (--loop): 99 of 100 answers are
           // no slower
    by_hand  // --floor
  };
  Source source = Source::device;
  Duration given{};  // by_hand
  results::ResponseTimes times = {};
  std::string remark = {};  // what was noticed while it was measured

  Duration floor() const;
};

/// Probes that are measured, and the time that this may take.
inline constexpr int floor_probes = 20;
inline constexpr Duration floor_budget = 2s;

/// What is below cannot be judged: what was given by hand; else the greatest of what is declared
/// (profile, endpoint) and what was measured. A device's fastest answer never excuses it from the
/// limit of its own answers.
Duration timing_floor(Duration declared, Duration response_max,
                      const std::optional<AdapterFloor>& measured);
/// The same for silence inside a reply, which the answer time of a device says nothing about.
Duration gap_floor(Duration declared, const std::optional<AdapterFloor>& measured);

inline bool given_by_hand(const std::optional<AdapterFloor>& measured) {
  return measured && measured->source == AdapterFloor::Source::by_hand;
}

/// "20.0 ms (the device's fastest of 20 answers took 0.412 ms, its own time included: median 0.5,
/// p99 1.2 ms)"
std::string to_string(const AdapterFloor& measured, Duration floor);

/// Behind a serial server whose packets take `round_trip`: what may hold the answers back, and what
/// to write there; empty where they come at once, or so late that it makes no difference.
std::string held_by_server(const AdapterFloor& measured, Duration round_trip);

}  // namespace fieldproof::bench
