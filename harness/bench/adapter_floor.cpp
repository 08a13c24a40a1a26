#include "harness/bench/adapter_floor.hpp"

#include <fmt/format.h>
#include <algorithm>

namespace fieldproof::bench {

Duration AdapterFloor::floor() const {
  switch (source) {
    case Source::by_hand: return given;
    case Source::loop: return from_ms(std::max(0.0, times.percentile(0.99)));
    case Source::device: break;
  }
  return from_ms(std::max({0.0, times.least(), times.percentile(0.95) - times.least()}));
}

Duration timing_floor(Duration declared, Duration response_max,
                      const std::optional<AdapterFloor>& measured) {
  if (!measured || measured->source != AdapterFloor::Source::device)
    return gap_floor(declared, measured);
  return std::max(declared, std::min(measured->floor(), response_max));
}

Duration gap_floor(Duration declared, const std::optional<AdapterFloor>& measured) {
  if (!measured || measured->source == AdapterFloor::Source::device) return declared;
  return given_by_hand(measured) ? measured->given : std::max(declared, measured->floor());
}

std::string to_string(const AdapterFloor& measured, Duration floor) {
  const std::string value = fmt::format("{:.1f} ms", to_ms(floor));
  if (measured.source == AdapterFloor::Source::by_hand) return value + " (given by hand)";
  if (measured.times.count() == 0) return value + " (declared; no probe was answered)";
  const results::ResponseFigures figures = results::figures_of(measured.times);
  const char* from = measured.source == AdapterFloor::Source::loop
                         ? "over the loop"
                         : "by the device, its own time included";
  return fmt::format("{} ({} answers {}: min {:.3f}, median {:.3f}, p99 {:.3f} ms){}", value,
                     figures.count, from, figures.least, figures.median, figures.p99,
                     measured.remark.empty() ? "" : "; " + measured.remark);
}

std::string held_by_server(const AdapterFloor& measured, Duration round_trip) {
  // ser2net 4.3 holds an answer for 3.2 ms by default (never less than 1, nor more than 20).
  constexpr double least_held_ms = 1, most_held_ms = 20;
  if (measured.source != AdapterFloor::Source::device || measured.times.count() == 0) return {};
  const double later = measured.times.least() - to_ms(round_trip);
  if (later < least_held_ms || later > most_held_ms) return {};
  return fmt::format(
      "the fastest answer took {:.1f} ms, a packet to the serial server and back {:.1f} ms: if "
      "ser2net is between, it holds each answer back for about 3 ms by default; `chardelay: false` "
      "under `options:` of its connection ends that. Else it is the device's own time",
      measured.times.least(), to_ms(round_trip));
}

}  // namespace fieldproof::bench
