#include "src/xnet_motion/axis_recorder.hpp"

#include <algorithm>
#include <cmath>

namespace fieldproof::xnet {

namespace {
constexpr std::size_t most_kept = 1024, most_shown = 300, most_events = 100;
constexpr double least_way = 1e-3;  // pulses
}  // namespace

void AxisRecorder::begin(const Sample& one) {
  begun_ = true;
  last_ = one;
  extremes_.fill(one);
}

/// Nor does a stretch of one speed cost more than its ends.
void AxisRecorder::change(const Sample& one, Duration period) {
  if (samples_.empty()) samples_.push_back(last_);
  // A quiet axis is not looked at: it stood until the period before.
  const Time before = one.time - period;
  const double due = last_.position + last_.speed * std::chrono::duration<double>(period).count();
  const bool steady =
      before <= last_.time && one.speed == last_.speed && std::abs(one.position - due) < least_way;
  if (!steady) {
    if (steady_) keep(last_);
    if (before > last_.time) keep({before, last_.position, last_.speed});
    keep(one);
  }
  steady_ = steady;
  last_ = one;
}

/// Each time that they are too many, every other one goes, and half as many come.
void AxisRecorder::keep(const Sample& one) {
  if (one.position < extremes_[0].position) extremes_[0] = one;
  if (one.position > extremes_[1].position) extremes_[1] = one;
  if (one.speed < extremes_[2].speed) extremes_[2] = one;
  if (one.speed > extremes_[3].speed) extremes_[3] = one;
  if (changes_++ % stride_ != 0) return;
  samples_.push_back(one);
  if (samples_.size() < most_kept) return;
  for (std::size_t i = 1; 2 * i < samples_.size(); ++i) samples_[i] = samples_[2 * i];
  samples_.resize((samples_.size() + 1) / 2);
  stride_ *= 2;
}

void AxisRecorder::note(std::string what) {
  if (events_.size() < most_events)
    events_.push_back({now_, std::move(what)});
  else
    events_.back().what = "and more that is not kept";
}

std::vector<AxisTrace::Sample> AxisRecorder::samples(Time now) const {
  if (!has_moved()) return {};
  std::vector<Sample> all = samples_;
  all.insert(all.end(), extremes_.begin(), extremes_.end());
  all.push_back(last_);
  all.push_back({std::max(now, last_.time), last_.position, last_.speed});
  std::ranges::stable_sort(all, {}, &Sample::time);
  const auto alike = [](const Sample& a, const Sample& b) { return a.time == b.time; };
  const auto [from, to] = std::ranges::unique(all, alike);
  all.erase(from, to);
  std::vector<Sample> few = thinned(all, most_shown);
  for (Sample& one : few)
    for (const auto what : {&Sample::position, &Sample::speed})
      one.*what = std::round(one.*what * 1000) / 1000 + 0.0;  // never -0
  return few;
}

}  // namespace fieldproof::xnet
