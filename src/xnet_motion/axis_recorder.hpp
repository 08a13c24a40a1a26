// How an axis moved, in bounded memory and next to no time: what its picture is drawn from.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "src/base/trace.hpp"

namespace fieldproof::xnet {

class AxisRecorder {
 public:
  using Sample = AxisTrace::Sample;

  /// What is added and noted next happens now.
  void tell(Time now) { now_ = now; }
  /// In each refresh period in which it may have moved. Standing costs no sample.
  void add(double position, double speed, Duration period) {
    if (position == last_.position && speed == last_.speed && begun_) return;
    const Sample one{now_, position, speed};
    begun_ ? change(one, period) : begin(one);
  }
  void note(std::string what);

  /// Did it ever have a speed? Who is given another position did not move.
  bool has_moved() const { return extremes_[2].speed < 0 || extremes_[3].speed > 0; }

  /// As far as `now`.
  std::vector<Sample> samples(Time now) const;
  const std::vector<AxisTrace::Event>& events() const { return events_; }

 private:
  void begin(const Sample& one);
  void change(const Sample& one, Duration period);
  void keep(const Sample& one);

  bool begun_ = false, steady_ = false;
  Time now_{};
  Sample last_;                  // change
  std::vector<Sample> samples_;  // each stride_-th change
  std::size_t stride_ = 1, changes_ = 0;
  std::array<Sample, 4> extremes_{};  // least and greatest position, least and greatest speed
  std::vector<AxisTrace::Event> events_;
};

}  // namespace fieldproof::xnet
