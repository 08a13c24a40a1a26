// How an axis moves on given time: pieces of constant acceleration (X-NET 2-2-1 to 2-2-4).
// Positions are in pulses, speeds in pulses a second, accelerations in pulses a second squared.
#pragma once

#include <vector>

#include "src/base/time.hpp"

namespace fieldproof::xnet {

struct State {
  double position = 0, speed = 0;
};

/// `speed`, `acceleration` and `deceleration` are above zero, but for a speed of 0: it stops.
/// `braking`: the deceleration at the end of the way, where it is another.
struct Limits {
  double speed = 0, acceleration = 0, deceleration = 0, braking = 0;
};

class Path {
 public:
  /// It stands.
  explicit Path(double position = 0) : start_{position, 0}, end_{position, 0} {}

  /// To `target`, where its speed is `end_speed` in the way's direction; it turns back where it
  /// cannot stop before. With a speed of 0 it stops where it can.
  static Path to(double target, State from, const Limits& limits, Time now, double end_speed = 0);
  /// To a speed, and on with it for ever.
  static Path at_speed(double speed, State from, const Limits& limits, Time now);
  static Path stop(State from, double deceleration, Time now);

  State at(Time now) const;
  State end() const { return end_; }
  bool ends() const { return !endless_; }
  bool is_over(Time now) const { return !endless_ && now >= ends_at_; }
  Time ends_at() const { return ends_at_; }

 private:
  struct Piece {
    double seconds = 0, acceleration = 0;
  };
  Path(State from, Time now) : start_(from), end_(from), begins_(now), ends_at_(now) {}
  void append(double seconds, double acceleration);
  void run_to(double target, const Limits& limits, double end_speed);

  State start_, end_;
  Time begins_{}, ends_at_{};
  std::vector<Piece> pieces_;
  bool endless_ = false;
};

}  // namespace fieldproof::xnet
