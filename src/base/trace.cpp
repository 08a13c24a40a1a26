#include "src/base/trace.hpp"

#include <algorithm>
#include <cmath>
#include <queue>
#include <set>

namespace fieldproof {

namespace {

using Sample = AxisTrace::Sample;

/// A stretch between two kept samples, and the one in it that the straight line misses most.
struct Stretch {
  std::size_t first = 0, last = 0, worst = 0;
  double missed = 0;
  bool operator<(const Stretch& other) const { return missed < other.missed; }
};

double line_at(Time time, const Sample& a, const Sample& b, double Sample::*what) {
  const double way = to_ms(b.time - a.time);
  return way > 0 ? a.*what + (b.*what - a.*what) * to_ms(time - a.time) / way : a.*what;
}

Stretch stretch(const std::vector<Sample>& all, std::size_t first, std::size_t last, Sample range) {
  Stretch one{first, last};
  for (std::size_t i = first + 1; i < last; ++i)
    for (const auto what : {&Sample::position, &Sample::speed}) {
      const double line = line_at(all[i].time, all[first], all[last], what);
      const double off = range.*what > 0 ? std::abs(all[i].*what - line) / range.*what : 0;
      if (off > one.missed) one.worst = i, one.missed = off;
    }
  return one;
}

}  // namespace

std::vector<Sample> thinned(const std::vector<Sample>& samples, std::size_t most, double missed) {
  if (samples.size() < 3) return samples;
  std::set<std::size_t> kept{0, samples.size() - 1};
  Sample range;
  for (const auto what : {&Sample::position, &Sample::speed}) {
    const auto [least, greatest] = std::ranges::minmax_element(samples, {}, what);
    range.*what = (*greatest).*what - (*least).*what;
    for (const auto extreme : {least, greatest})
      kept.insert(static_cast<std::size_t>(extreme - samples.begin()));
  }
  std::priority_queue<Stretch> open;
  for (auto at = kept.begin(); std::next(at) != kept.end(); ++at)
    open.push(stretch(samples, *at, *std::next(at), range));
  while (kept.size() < most && !open.empty() && open.top().missed > missed) {
    const Stretch worst = open.top();
    open.pop();
    kept.insert(worst.worst);
    open.push(stretch(samples, worst.first, worst.worst, range));
    open.push(stretch(samples, worst.worst, worst.last, range));
  }
  std::vector<Sample> few;
  for (const std::size_t at : kept) few.push_back(samples[at]);
  return few;
}

}  // namespace fieldproof
