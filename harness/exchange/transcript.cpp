#include "harness/exchange/transcript.hpp"

#include <utility>

namespace fieldproof::exchange {

void Received::add(const Burst& burst, std::size_t event) {
  arrivals.push_back({bytes.size(), burst.start, burst.end(), event, 0});
  bytes.insert(bytes.end(), burst.bytes.begin(), burst.bytes.end());
}

void Received::append(Received other) {
  for (Arrival& arrival : other.arrivals) {
    arrival.offset += bytes.size();
    arrivals.push_back(arrival);
  }
  bytes.insert(bytes.end(), other.bytes.begin(), other.bytes.end());
}

Received Received::take(std::size_t count) {
  if (count >= bytes.size()) return std::exchange(*this, {});
  Received taken;
  taken.bytes.assign(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(count));
  bytes.erase(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(count));
  std::vector<Arrival> rest;
  for (Arrival& arrival : arrivals) {
    if (arrival.offset < count) {
      taken.arrivals.push_back(arrival);
    } else {
      arrival.offset -= count;
      rest.push_back(arrival);
    }
  }
  // A burst that is cut in two: its later part came no later than the burst ended.
  if (rest.empty() || rest.front().offset > 0) {
    const Arrival& cut = taken.arrivals.back();
    rest.insert(rest.begin(),
                {0, cut.end, cut.end, cut.event, cut.event_offset + count - cut.offset});
  }
  arrivals = std::move(rest);
  return taken;
}

}  // namespace fieldproof::exchange
