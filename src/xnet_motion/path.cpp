#include "src/xnet_motion/path.hpp"

#include <algorithm>
#include <cmath>

namespace fieldproof::xnet {

namespace {

double square(double x) { return x * x; }
Duration from_seconds(double seconds) { return Duration(std::llround(seconds * 1e9)); }

State after(State from, double seconds, double acceleration) {
  return {from.position + from.speed * seconds + acceleration * square(seconds) / 2,
          from.speed + acceleration * seconds};
}

}  // namespace

void Path::append(double seconds, double acceleration) {
  if (seconds <= 0) return;
  pieces_.push_back({seconds, acceleration});
  end_ = after(end_, seconds, acceleration);
  ends_at_ += from_seconds(seconds);
}

/// From end_, which does not move away from `target` and can stop before it.
void Path::run_to(double target, const Limits& limits, double end_speed) {
  const double way = std::abs(target - end_.position), sign = target < end_.position ? -1 : 1;
  const double speed = std::abs(end_.speed);
  const double acc = limits.acceleration;
  const double dec = limits.braking > 0 ? limits.braking : limits.deceleration;
  if (speed > limits.speed) {
    append((speed - limits.speed) / limits.deceleration, -sign * limits.deceleration);
    const double left =
        std::abs(target - end_.position) - (square(limits.speed) - square(end_speed)) / (2 * dec);
    append(std::max(left, 0.0) / limits.speed, 0);
  } else {
    const double peak_square =
        (2 * way * acc * dec + dec * square(speed) + acc * square(end_speed)) / (acc + dec);
    const double peak = std::min(std::sqrt(std::max(peak_square, 0.0)), limits.speed);
    append((peak - speed) / acc, sign * acc);
    const double braking = std::max(square(peak) - square(end_speed), 0.0) / (2 * dec);
    append((std::abs(target - end_.position) - braking) / limits.speed, 0);
  }
  append((std::abs(end_.speed) - end_speed) / dec, -sign * dec);
  end_ = {target, sign * end_speed};
}

Path Path::to(double target, State from, const Limits& limits, Time now, double end_speed) {
  Path path(from, now);
  const double way = target - from.position;
  const double braking = square(from.speed) / (2 * limits.deceleration);
  const bool away = way * from.speed < 0;
  const bool too_near = from.speed != 0 && braking - square(end_speed) / (2 * limits.deceleration) >
                                               std::abs(way) + 1e-9;
  if (away || too_near || limits.speed <= 0) {
    path.append(std::abs(from.speed) / limits.deceleration,
                from.speed > 0 ? -limits.deceleration : limits.deceleration);
    path.end_.speed = 0;
  }
  if (limits.speed > 0) path.run_to(target, limits, end_speed);
  return path;
}

Path Path::at_speed(double speed, State from, const Limits& limits, Time now) {
  Path path(from, now);
  if (from.speed * speed < 0) {
    path = stop(from, limits.deceleration, now);
    from = path.end_;
  }
  const bool faster = std::abs(speed) > std::abs(from.speed);
  const double rate = faster ? limits.acceleration : limits.deceleration;
  path.append(std::abs(speed - from.speed) / rate, speed > from.speed ? rate : -rate);
  path.end_.speed = speed;
  path.endless_ = speed != 0;
  return path;
}

Path Path::stop(State from, double deceleration, Time now) {
  Path path(from, now);
  path.append(std::abs(from.speed) / deceleration, from.speed > 0 ? -deceleration : deceleration);
  path.end_.speed = 0;
  return path;
}

State Path::at(Time now) const {
  if (is_over(now)) return end_;
  double left = std::chrono::duration<double>(now - begins_).count();
  State state = start_;
  for (const Piece& piece : pieces_) {
    if (left <= piece.seconds) return after(state, left, piece.acceleration);
    state = after(state, piece.seconds, piece.acceleration);
    left -= piece.seconds;
  }
  return after(state, left, 0);
}

}  // namespace fieldproof::xnet
