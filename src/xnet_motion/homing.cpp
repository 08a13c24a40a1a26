#include "src/xnet_motion/homing.hpp"

namespace fieldproof::xnet {

Homing::Homing(int mode, double direction, Speeds speeds, Signals now)
    : mode_(mode), direction_(direction), speeds_(speeds), last_(now) {
  if (is_hard() && at_limit(now)) phase_ = Phase::backing;
}

double Homing::wished_speed() const {
  switch (phase_) {
    case Phase::backing: return -direction_ * speeds_.high;
    case Phase::creeping: return -direction_ * speeds_.creep;
    default: return direction_ * (slow_ ? speeds_.low : speeds_.high);
  }
}

Homing::Step Homing::look(Signals now, double speed) {
  const Step step = advance(now, speed);
  last_ = now;
  return step;
}

/// Forward, the rising edge of the origin is sought and its falling edge ends it; in reverse it is
/// the other way round, so that both end at the same edge of the switch.
Homing::Step Homing::advance(Signals now, double speed) {
  const bool forward = direction_ > 0;
  const bool rises = now.origin && !last_.origin, falls = !now.origin && last_.origin;
  const bool right_way = speed * wished_speed() > 0;
  if (phase_ == Phase::creeping) {
    if (!right_way || !(forward ? falls : rises)) return {Wish::go, wished_speed()};
    return {mode_ % 10 == 2 ? Wish::find_z : Wish::done, wished_speed()};
  }
  if (phase_ == Phase::backing) {
    if (right_way && falls) phase_ = Phase::seeking_again;
    return {Wish::go, wished_speed()};
  }
  if (at_limit(now)) {
    if (!is_hard() || phase_ == Phase::seeking_again) return {Wish::failed, 0};
    phase_ = Phase::backing;
    slow_ = false;
    return {Wish::go, wished_speed()};
  }
  const bool close_rises = now.close && !last_.close, close_falls = !now.close && last_.close;
  if (right_way && (is_hard() && !forward ? close_falls : close_rises)) slow_ = true;
  if (right_way && (forward ? rises : falls)) phase_ = Phase::creeping;
  return {Wish::go, wished_speed()};
}

}  // namespace fieldproof::xnet
