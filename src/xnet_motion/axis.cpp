// What an axis is told, and how it moves. What it looks at, and what it shows: axis_state.cpp.
#include "src/xnet_motion/axis.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace fieldproof::xnet {

namespace {
constexpr double speed_when_enabled = 1000;  // 2-2-1
}  // namespace

Axis::Axis(Memory& memory, Servo servo)
    : memory_(memory),
      inputs_(memory.body(area_named("X"))),
      registers_(memory, servo.axis),
      servo_(std::move(servo)) {
  registers_.initialise();
  state_.position = feedback_ = start_ = published_ = servo_.start;
  path_ = Path(state_.position);
  lost_ = !servo_.connected;
}

void Axis::fail(AxisError error) {
  recorder_.note("error " + std::to_string(static_cast<int>(error)));
  registers_.set(reg::error, static_cast<int>(error));
  registers_.set(reg::error_flag, 1);
}

void Axis::clear_error() {
  registers_.set(reg::error, 0);
  registers_.set(reg::error_flag, 0);
}

void Axis::shut_off(AxisError error) {
  fail(error);
  disable();
  refused_ = true;
}

// ---- what it is told ----

bool Axis::may_start() {
  if (enabled_ && !is_moving() && !bound_) return true;
  fail(AxisError::not_ready);
  return false;
}

bool Axis::may_go(double target, double speed, double ms) {
  if (target < registers_.get(reg::min_limit) || target > registers_.get(reg::max_limit))
    fail(AxisError::target);
  else if (speed > max_speed())
    fail(AxisError::speed);
  else if (ms <= 0)
    fail(AxisError::time);
  else
    return true;
  return false;
}

/// What refused an instruction before is over with the next good one (DECISIONS.md xnet/clear).
void Axis::begin(Doing doing) {
  const auto error = static_cast<AxisError>(static_cast<int>(registers_.get(reg::error)));
  if (error >= AxisError::target && error <= AxisError::bound_not_ready) clear_error();
  doing_ = doing;
  start_ = state_.position;
  stopped_.reset();
  registers_.set(reg::completed, 0);
  registers_.set(reg::running, 1);
}

void Axis::plan(double target, Time now, double end_speed) {
  const bool last = doing_ == Doing::segments && segment_ + 1 == segments_.size();
  const Limits limits{std::min(speed_, max_speed()), acceleration_, deceleration_,
                      last ? last_slope_ : 0};
  path_ = Path::to(target, state_, limits, now, std::min(end_speed, limits.speed));
}

void Axis::move(bool relative, double position, double speed, double ms, Time now) {
  if (!may_start()) return;
  const double here = state_.position + (in_loop_ ? loop_shift_ : 0);
  const double target = (relative ? here + position : position) - (in_loop_ ? loop_shift_ : 0);
  speed = std::abs(speed);
  if (!may_go(target, speed, ms)) return;
  begin(Doing::moving);
  changes_.clear();
  goal_ = target;
  speed_ = speed;
  if (speed > 0) {
    acceleration_ = steepest(speed * 1000 / ms, reg::least_acceleration);
    deceleration_ = steepest(speed * 1000 / ms, reg::least_deceleration);
  }
  expect(reg::target, goal_);
  expect(reg::speed_setting, speed_);
  expect(reg::acceleration, time_of(acceleration_));
  expect(reg::deceleration, time_of(deceleration_));
  plan(goal_, now);
  if (target == state_.position) arrive();
}

void Axis::move_segments(bool relative, std::vector<Segment> segments, double acceleration_ms,
                         double deceleration_ms, Time now) {
  if (!may_start()) return;
  if (segments.empty() || segments.size() > 100) return fail(AxisError::segments);
  double at = state_.position;
  for (Segment& one : segments) {
    one.position += relative ? at : 0;
    one.speed = std::abs(one.speed);
    if (!may_go(one.position, one.speed, std::min(acceleration_ms, deceleration_ms))) return;
    at = one.position;
  }
  begin(Doing::segments);
  changes_.clear();
  segments_ = std::move(segments);
  segment_ = 0;
  const auto slope_to = [](double speed, double ms) { return std::max(speed, 1.0) * 1000 / ms; };
  acceleration_ =
      steepest(slope_to(segments_.front().speed, acceleration_ms), reg::least_acceleration);
  last_slope_ =
      steepest(slope_to(segments_.back().speed, deceleration_ms), reg::least_deceleration);
  expect(reg::acceleration, time_of(acceleration_));
  next_segment(now);
}

/// The one that segment_ names. It is passed at its speed where the next one goes the same way.
void Axis::next_segment(Time now) {
  const Segment& one = segments_[segment_];
  const bool last = segment_ + 1 == segments_.size();
  const double way = one.position - state_.position;
  const bool goes_on = !last && (segments_[segment_ + 1].position - one.position) * way > 0;
  goal_ = one.position;
  speed_ = one.speed;
  deceleration_ = acceleration_;
  expect(reg::target, goal_);
  expect(reg::speed_setting, speed_);
  expect(reg::deceleration, time_of(last_slope_));
  plan(goal_, now, goes_on ? speed_ : 0);
}

void Axis::stop(double how, Time now) {
  if (!is_moving()) return;
  if (doing_ != Doing::nothing) state_ = path_.at(now);
  const Stopped stopped{doing_, goal_};
  if (how < 0) {
    stop_at_once();
    release();
  } else if (how == 0) {
    // In the time that SD2036 shows (X-NET 2-2-4).
    path_ = Path::stop(state_, doing_ == Doing::segments ? last_slope_ : deceleration_, now);
    goal_ = path_.end().position;
    doing_ = Doing::moving;
  } else {
    const double target = state_.position + (state_.speed < 0 ? -how : how);
    goal_ = std::clamp(target, registers_.get(reg::min_limit), registers_.get(reg::max_limit));
    doing_ = Doing::moving;
    plan(goal_, now);
  }
  if (stopped.doing == Doing::moving || stopped.doing == Doing::segments) stopped_ = stopped;
}

void Axis::go_on(Time now) {
  if (!stopped_) return;
  if (!enabled_ || is_moving()) return fail(AxisError::not_ready);
  const Stopped stopped = *stopped_;
  begin(stopped.doing);
  goal_ = stopped.goal;
  if (doing_ == Doing::segments) return next_segment(now);
  expect(reg::target, goal_);
  plan(goal_, now);
}

void Axis::write_position(double position) {
  if (doing_ == Doing::segments || bound_) return;
  if (is_moving()) return fail(AxisError::not_ready);
  const double moved = position - state_.position;
  machine_ -= moved;
  loop_shift_ -= moved;
  state_.position = feedback_ = published_ = position;
  path_ = Path(position);
  expect(reg::target, position);
}

void Axis::push(double pulses) {
  const bool has_no_force =
      servo_.parameter("P0-01") == 8 && registers_.get(reg::torque_setting) == 0;
  if (enabled_ && !has_no_force) return;
  state_.position += pulses;
  feedback_ = state_.position;  // its register has the old one, and nobody wrote that
  path_ = Path(state_.position);
}

// ---- as a slave ----

void Axis::bind(double ratio) {
  bound_ = true;
  start_ = state_.position;
  registers_.set(reg::ratio, ratio);
}

void Axis::release() {
  if (!bound_) return;
  state_.speed = 0;
  bound_ = false;
  path_ = Path(state_.position);
}

void Axis::follow(double way, double speed, Time now) {
  const double ratio = registers_.get(reg::ratio);
  state_.position += ratio * way;
  state_.speed = ratio * speed;
  if (std::abs(state_.speed) <= max_speed()) return;
  fail(AxisError::over_speed);
  bound_ = false;
  doing_ = Doing::moving;
  path_ = Path::stop(state_, deceleration_, now);
  goal_ = path_.end().position;
}

// ---- how it moves ----

double Axis::steepest(double slope, const Register& fastest) const {
  const double ms = registers_.get(fastest);
  return ms > 0 ? std::min(slope, max_speed() * 1000 / ms) : slope;
}

double Axis::slope(const Register& time, const Register& fastest) const {
  const double ms = std::max({registers_.get(time), registers_.get(fastest), 1.0});
  return max_speed() * 1000 / ms;
}

void Axis::take_ramps() {
  acceleration_ = slope(reg::acceleration, reg::least_acceleration);
  deceleration_ = slope(reg::deceleration, reg::least_deceleration);
}

void Axis::enable() {
  const double mode = registers_.get(reg::mode), encoder = registers_.get(reg::encoder);
  if (refused_) return;
  refused_ = true;
  if (mode != 0 && mode != 1 && mode != 3) return fail(AxisError::mode);
  if (encoder < 1 || encoder > 5) return fail(AxisError::encoder);
  if (servo_.enabled_by_hand) return fail(AxisError::enabled_already);
  refused_ = false;
  enabled_ = true;
  recorder_.note("enabled");
  registers_.set(reg::jog_step, registers_.get(reg::first_jog_step));
  registers_.set(reg::jog_speed, registers_.get(reg::first_jog_speed));
  registers_.set(reg::width, registers_.get(reg::first_width));
  registers_.set(reg::gain, registers_.get(reg::first_gain));
  take_ramps();
  speed_ = speed_when_enabled;
  expect(reg::speed_setting, speed_);
  expect(reg::target, state_.position);
  path_ = Path(state_.position);
  changes_.clear();
}

void Axis::disable() {
  if (enabled_) recorder_.note("disabled");
  stop_at_once();
  enabled_ = false;
  feedback_ = published_ = state_.position = servo_.stalled ? feedback_ : state_.position;
  path_ = Path(state_.position);
  release();
}

void Axis::stop_at_once() {
  state_.speed = 0;
  path_ = Path(state_.position);
  doing_ = Doing::nothing;
  homing_.reset();
  stopped_.reset();
}

void Axis::arrive() {
  doing_ = Doing::nothing;
  state_ = {goal_, 0};
  path_ = Path(goal_);
  registers_.set(reg::completed, 1);
  recorder_.note("completed");
}

void Axis::move_on(Time now) {
  if (bound_) return;
  if (doing_ == Doing::nothing || doing_ == Doing::at_speed) return keep_speed(now);
  if (doing_ == Doing::homing) return home_on(now);
  while (doing_ == Doing::segments && path_.is_over(now) && path_.end().position == goal_ &&
         segment_ + 1 < segments_.size()) {
    state_ = path_.end();
    ++segment_;
    recorder_.note("segment " + std::to_string(segment_ + 1));
    next_segment(path_.ends_at());
    state_ = path_.at(now);
  }
  if (!path_.is_over(now) || path_.end().position != goal_) return;  // or it stands, with speed 0
  if (doing_ == Doing::finding_z) return end_homing();
  const double missing = std::abs(goal_ - feedback_);
  if (missing == 0 || missing < registers_.get(reg::width)) arrive();
}

/// Speed and torque mode (2-3-1, 2-3-2): the drive has no ramp of the PLC.
void Axis::keep_speed(Time now) {
  const int mode = servo_.parameter("P0-01");
  if (!enabled_ || registers_.get(reg::mode) != 3 || (mode != 9 && mode != 8)) return;
  double speed = registers_.get(reg::speed_setting);
  if (mode == 8) {
    const double torque = registers_.get(reg::torque_setting);
    speed = torque == 0 ? 0 : std::copysign(std::abs(speed), torque);
  }
  speed = std::clamp(speed, -max_speed(), max_speed());
  if (speed == state_.speed) return;
  if (doing_ == Doing::nothing) start_ = state_.position;
  state_.speed = speed;
  path_ = Path::at_speed(speed, state_, {std::abs(speed), 1, 1}, now);
  doing_ = speed == 0 ? Doing::nothing : Doing::at_speed;
}

// ---- return to origin ----

void Axis::home(double sign, Time now) {
  recorder_.note(sign > 0 ? "return to origin, forward" : "return to origin, reverse");
  if (!may_start()) return;
  const Terminal origin = terminal(reg::origin_terminal), close = terminal(reg::close_terminal);
  if (!origin.input || !close.exists) return fail(AxisError::home_terminal);
  const int mode = static_cast<int>(registers_.get(reg::home_mode));
  if (mode != 0 && mode != 2 && mode != 10 && mode != 12) return fail(AxisError::home_failed);
  begin(Doing::homing);
  const Homing::Speeds speeds{registers_.get(reg::home_high), registers_.get(reg::home_low),
                              registers_.get(reg::home_creep)};
  take_ramps();
  homing_.emplace(mode, sign, speeds, signals());
  home_on(now);
}

void Axis::home_on(Time now) {
  const Homing::Step step = homing_->look(signals(), state_.speed);
  switch (step.wish) {
    case Homing::Wish::done: return end_homing();
    case Homing::Wish::find_z: return find_z(step.speed, now);
    case Homing::Wish::failed: stop_at_once(); return fail(AxisError::home_failed);
    case Homing::Wish::go: break;
  }
  const double speed = std::clamp(step.speed, -max_speed(), max_speed());
  if (path_.end().speed != speed || path_.ends())
    path_ = Path::at_speed(speed, state_, {std::abs(speed), acceleration_, deceleration_}, now);
}

/// Onward to the next Z phase of the encoder (DECISIONS.md xnet/homing); P7-20: which one.
void Axis::find_z(double speed, Time now) {
  const double turn = pulses_of_a_turn();
  const int wanted = servo_.parameter("P7-20");
  const double direction = (speed < 0) == (wanted < 0) ? 1 : -1;
  const double turns = (place() - servo_.z_phase) / turn;
  const double next = direction > 0 ? std::floor(turns) + 1 : std::ceil(turns) - 1;
  const double z = servo_.z_phase + (next + direction * std::max(std::abs(wanted) - 1, 0)) * turn;
  goal_ = z - machine_;
  speed_ = std::abs(speed);
  doing_ = Doing::finding_z;
  plan(goal_, now);
}

void Axis::end_homing() {
  stop_at_once();
  write_position(registers_.get(reg::origin));
  start_ = state_.position;
  registers_.set(reg::completed, 1);
  recorder_.note("origin found");
}

}  // namespace fieldproof::xnet
