#include "harness/bench/transcript.hpp"

#include <utility>

namespace fieldproof {

void Received::add(const Burst& burst) {
  arrivals.push_back({bytes.size(), burst.start, burst.end()});
  bytes.insert(bytes.end(), burst.bytes.begin(), burst.bytes.end());
}

void Received::append(Received other) {
  for (const Arrival& arrival : other.arrivals) arrivals.push_back({arrival.offset + bytes.size(), arrival.start, arrival.end});
  bytes.insert(bytes.end(), other.bytes.begin(), other.bytes.end());
}

Received Received::take(std::size_t count) {
  if (count >= bytes.size()) return std::exchange(*this, {});
  Received taken;
  taken.bytes.assign(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(count));
  bytes.erase(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(count));
  std::vector<Arrival> rest;
  for (const Arrival& arrival : arrivals) {
    if (arrival.offset < count) taken.arrivals.push_back(arrival);
    else rest.push_back({arrival.offset - count, arrival.start, arrival.end});
  }
  // A burst that is cut in two: its later part came no later than the burst ended.
  if (rest.empty() || rest.front().offset > 0) rest.insert(rest.begin(), {0, taken.arrivals.back().end, taken.arrivals.back().end});
  arrivals = std::move(rest);
  return taken;
}

}  // namespace fieldproof
