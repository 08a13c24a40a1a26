#include "src/base/medium.hpp"

#include <algorithm>

namespace fieldproof {

namespace {
std::optional<Burst> take_from_any(std::span<Medium* const> media) {
  for (Medium* medium : media)
    if (std::optional<Burst> burst = medium->take()) return burst;
  return std::nullopt;
}

Time first_event(std::span<Medium* const> media, Time until) {
  for (const Medium* medium : media) until = std::min(until, medium->next_event().value_or(until));
  return until;
}
}  // namespace

Burst receive_in_step(std::span<Medium* const> media, Time until) {
  for (;;) {
    if (std::optional<Burst> burst = take_from_any(media)) return std::move(*burst);
    const Time now = media.front()->now();
    until = std::max(until, now);
    const Time next = first_event(media, Time::max());
    if (next > now && until == now) break;  // nothing happens at this moment
    for (Medium* medium : media) medium->run(std::min(next, until));
    // What one did may have given another something to do at the same moment.
    if (next > until) break;
  }
  if (std::optional<Burst> burst = take_from_any(media)) return std::move(*burst);
  for (Medium* medium : media)
    if (std::optional<Burst> part = medium->take_part()) return std::move(*part);
  return {.bytes = {}, .start = until};
}

}  // namespace fieldproof
