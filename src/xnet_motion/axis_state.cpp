// What an axis looks at in each refresh period, and what it shows in its registers.
#include <algorithm>
#include <cmath>
#include <string>

#include "src/xnet_motion/axis.hpp"

namespace fieldproof::xnet {

namespace {

constexpr std::array settings{reg::target, reg::speed_setting, reg::acceleration,
                              reg::deceleration};
constexpr Duration loop_time = 30ms;  // "up to 50ms" (2-3-5)
constexpr Duration latency = 6ms;     // after it was seen (DECISIONS.md xnet/refresh)
constexpr unsigned inputs = 64;       // X0 to X77
constexpr int no_terminal = 0xFF, inverse_x0 = -30000;

}  // namespace

void Axis::refresh(Time now, Duration period, bool run, unsigned slaves) {
  recorder_.tell(now);
  look_at_servo(run, slaves, period);
  if (doing_ != Doing::nothing) state_ = path_.at(now);
  move_feedback();
  move_switches();
  look_at_limits();
  look_at_loop(now);
  if (run) look_at_coils(now);
  look_at_settings(now);
  move_on(now);
  const double speed = present_speed();
  publish(speed);
  record(speed, period);
  const bool wants_more = registers_.on(reg::full_loop) != in_loop_ ||
                          (registers_.on(reg::enable) && !enabled_ && right_ && !refused_);
  quiet_ = doing_ == Doing::nothing && !bound_ && !in_loop_ && !loop_turns_ && changes_.empty() &&
           !wants_more && !servo_.counters.is_disturbed();
}

void Axis::expect(const Register& setting, double value) {
  registers_.set(setting, value);
  for (std::size_t i = 0; i < settings.size(); ++i)
    if (settings[i].first == setting.first) seen_[i] = registers_.get(setting);
}

// ---- the drive ----

void Axis::look_at_servo(bool run, unsigned slaves, Duration period) {
  const auto refresh_us = static_cast<unsigned>(period / 1us);
  if (checked_.slaves != slaves || checked_.refresh_us != refresh_us)
    checked_ = {slaves, refresh_us, bool(check_servo(servo_, slaves, refresh_us))};
  // "Cannot switch when running", and not with a servo on the bus (2-3-6).
  if (!is_moving()) simulates_ = registers_.on(reg::simulation);
  if (servo_.connected)
    servo_.counters.refresh(static_cast<unsigned>(std::max(servo_.parameter("P7-06"), 1)));
  right_ = servo_.connected ? checked_.right && !servo_.counters.is_lost() : simulates_;
  if (!run) {
    if (is_moving()) {
      recorder_.note("PLC in STOP");
      stop_at_once();
    }
    // 2-2-8: in STOP, who changes the feedback pulses changes the position.
    const double turn = pulses_of_a_turn(), ppr = registers_.get(reg::ppr);
    const double pulses = registers_.get(reg::feedback_pulses);
    if (ppr > 0 && pulses != std::round(published_ * ppr / turn))
      write_position(pulses * turn / ppr);
  }
  if (!right_ && !lost_) {
    registers_.set(reg::bus_errors, registers_.get(reg::bus_errors) + 1);
    if (enabled_) {
      fail(AxisError::communication);
      cut_ = true;
    }
  }
  lost_ = !right_;
  if (servo_.alarm && enabled_) fail(AxisError::servo_alarm);
  const bool wanted = registers_.on(reg::enable);
  if (!wanted) refused_ = false;
  if (enabled_ && (!wanted || !right_ || servo_.alarm)) {
    disable();
    refused_ = wanted;
  } else if (wanted && !enabled_ && right_ && !servo_.alarm && run) {
    enable();
  }
}

bool Axis::is_held() const {
  const int mode = servo_.parameter("P0-01");
  if ((mode != 9 && mode != 10) || registers_.get(reg::torque_mode) != 1) return false;
  return (state_.speed > 0 && registers_.get(reg::torque_setting) == 0) ||
         (state_.speed < 0 && registers_.get(reg::reverse_torque) == 0);
}

void Axis::move_feedback() {
  const double behind = state_.position - feedback_;
  if (is_held()) {  // it stays behind for good
    state_.position -= behind;
    path_ = Path(state_.position);
  }
  if (!servo_.stalled) feedback_ = state_.position;
  const double most = registers_.get(reg::deviation);
  if (!enabled_ || most < 0) return;
  // Nobody plans a position in speed mode: the motor runs away from where it was (2-3-1).
  const double due = doing_ == Doing::at_speed ? start_ : state_.position;
  if (std::abs(due - feedback_) <= most) return;
  state_.position = feedback_;
  shut_off(AxisError::deviation);
}

// ---- switches and limits ----

void Axis::move_switches() {
  const double machine = machine_at(feedback_);
  for (const Switch& one : servo_.switches)
    inputs_[one.terminal] = machine >= one.from && machine <= one.to;
}

double Axis::machine_at(double position) const {
  const bool other_way = registers_.get(reg::direction) != 0;
  return (other_way ? -1 : 1) * (position + machine_);
}

Axis::Terminal Axis::terminal(const Register& one) const {
  const int value = static_cast<int>(registers_.get(one));
  if (value == no_terminal) return {};
  const bool inverse = value < 0;
  const unsigned input = value == inverse_x0 ? 0 : static_cast<unsigned>(std::abs(value));
  if (input >= inputs) return {std::nullopt, inverse, false};
  return {input, inverse};
}

bool Axis::is_on(const Register& one) const {
  const Terminal where = terminal(one);
  if (!where.input) return false;
  return (inputs_[*where.input] != 0) != where.inverse;
}

Signals Axis::signals() const {
  return {is_on(reg::min_terminal), is_on(reg::max_terminal), is_on(reg::close_terminal),
          is_on(reg::origin_terminal)};
}

void Axis::look_at_limits() {
  const Signals now = signals();
  note_edges(now);
  const bool below = feedback_ < registers_.get(reg::min_limit);
  const bool above = feedback_ > registers_.get(reg::max_limit);
  registers_.set(reg::at_min, below || now.min);
  registers_.set(reg::at_max, above || now.max);
  if (!is_moving()) return;
  const double speed = state_.speed;
  if (doing_ == Doing::homing || doing_ == Doing::finding_z) {
    if ((above && speed > 0) || (below && speed < 0)) {
      fail(AxisError::home_failed);
      stop_at_once();
    }
    return;
  }
  AxisError error = AxisError::none;
  if (above && speed > 0) error = AxisError::over_max;
  if (below && speed < 0) error = AxisError::under_min;
  if (now.max && speed > 0) error = AxisError::max_switch;
  if (now.min && speed < 0) error = AxisError::min_switch;
  if (error == AxisError::none) return;
  fail(error);
  stop_at_once();
  release();
}

// ---- full closed loop (2-3-5) ----

void Axis::look_at_loop(Time now) {
  const bool wanted = registers_.on(reg::full_loop) && enabled_;
  if (wanted != in_loop_ && !loop_turns_) loop_turns_ = now + loop_time;
  if (loop_turns_ && now >= *loop_turns_) {
    loop_turns_.reset();
    if (wanted != in_loop_ && !is_moving()) turn_loop(wanted);
  }
  in_loop_ = in_loop_ && loop_counter();
  if (!in_loop_) return;
  const double counted = state_.position + loop_shift_;
  const double numerator = registers_.get(reg::loop_numerator);
  const double turn = pulses_of_a_turn();
  const double count = std::round(counted * numerator / turn);
  write_number(memory_, *loop_counter(), Kind::dword, count);
  const double gain = registers_.get(reg::gain), most = registers_.get(reg::loop_deviation);
  const double lag = gain > 0 ? state_.speed / gain : 0;
  registers_.set(reg::loop_position,
                 std::round(numerator > 0 ? count * turn / numerator - lag : 0));
  registers_.set(reg::loop_pulses, count);
  if (!is_moving() || state_.speed == 0) return;
  const bool backwards = registers_.get(reg::direction) != 0;
  if (!backwards && gain > 0 && std::abs(state_.speed) / gain <= most) return;
  shut_off(AxisError::deviation);
}

std::optional<Component> Axis::loop_counter() const {
  const double counter = registers_.get(reg::loop_counter);  // 0: HSC0, 1: HSC2
  if (counter < 0 || counter > 3) return std::nullopt;
  return component_in("HSCD", static_cast<std::uint32_t>(counter) * 2);
}

void Axis::turn_loop(bool on) {
  in_loop_ = on && loop_counter();
  if (!in_loop_) return;
  registers_.set(reg::gain, registers_.get(reg::first_gain));
  const double numerator = std::max(registers_.get(reg::loop_numerator), 1.0);
  const double count = read_number(memory_, *loop_counter(), Kind::dword);
  loop_shift_ = count * pulses_of_a_turn() / numerator - state_.position;
}

// ---- coils and settings ----

void Axis::look_at_coils(Time now) {
  if (registers_.take(reg::clear_alarm) && servo_.alarm && servo_.clearable) {
    servo_.alarm = false;
    clear_error();
  }
  if (registers_.take(reg::jog_forward)) jog(1, now);
  if (registers_.take(reg::jog_reverse)) jog(-1, now);
  if (registers_.take(reg::home_forward)) home(1, now);
  if (registers_.take(reg::home_reverse)) home(-1, now);
  if (registers_.take(reg::slow_stop)) {
    recorder_.note("decelerate and stop");
    stop(0, now);
  }
}

void Axis::jog(double sign, Time now) {
  recorder_.note(sign > 0 ? "jog forward" : "jog reverse");
  if (!enabled_ || bound_ || (is_moving() && doing_ != Doing::jogging))
    return fail(AxisError::not_ready);
  const double step = registers_.get(reg::jog_step);
  if (doing_ != Doing::jogging) begin(Doing::jogging);
  goal_ = state_.position + sign * step;
  speed_ = std::abs(registers_.get(reg::jog_speed));
  take_ramps();
  expect(reg::target, goal_);
  plan(goal_, now);
}

/// Who changed a setting waits 6 to 16 ms for its effect (2-2-1).
void Axis::look_at_settings(Time now) {
  for (std::size_t i = 0; i < settings.size(); ++i) {
    const double value = registers_.get(settings[i]);
    if (value == seen_[i]) continue;
    seen_[i] = value;
    changes_.push_back({i, value, now + latency});
  }
  while (!changes_.empty() && changes_.front().due <= now) {
    const Change change = changes_.front();
    changes_.pop_front();
    apply(settings[change.setting], change.value, now);
  }
}

void Axis::apply(const Register& setting, double value, Time now) {
  recorder_.note(std::string(setting.name) + " " + std::to_string(std::llround(value)));
  const bool free = enabled_ && !bound_ && doing_ != Doing::homing && doing_ != Doing::finding_z &&
                    doing_ != Doing::at_speed && doing_ != Doing::jogging;
  const bool in_segments = doing_ == Doing::segments;
  if (setting.first == reg::speed_setting.first) {
    speed_ = std::abs(value);
    if (free && in_segments) {
      const bool stays = path_.end().speed != 0;
      plan(goal_, now, stays ? speed_ : 0);
    } else if (free && doing_ == Doing::moving) {
      plan(goal_, now);
    }
    return;
  }
  if (in_segments) return;  // 2-2-3: neither target nor times
  if (setting.first == reg::target.first) {
    if (!free || registers_.get(reg::mode) == 3) return;
    if (doing_ == Doing::nothing) begin(Doing::moving);
    goal_ = value - (in_loop_ ? loop_shift_ : 0);
  } else {
    take_ramps();
  }
  if (free && doing_ == Doing::moving) plan(goal_, now);
}

// ---- what it shows ----

double Axis::present_speed() const {
  const bool stands = servo_.stalled || !enabled_ || is_held();
  return stands ? 0 : state_.speed;
}

void Axis::publish(double speed) {
  registers_.set(reg::status, !right_ ? 0 : enabled_ ? 2 : 1);
  registers_.set(reg::enabled, enabled_);
  registers_.set(reg::running, is_moving());
  registers_.set(reg::bound, bound_);
  registers_.set(reg::position, feedback_);
  registers_.set(reg::offset, feedback_ - start_);
  registers_.set(reg::speed, speed);
  registers_.set(reg::set_speed, state_.speed);
  if (doing_ == Doing::segments) registers_.set(reg::segment, static_cast<double>(segment_ + 1));
  const bool fed_back =
      registers_.get(reg::torque_feedback) == 1 && servo_.parameter("P7-02") == 3 && enabled_;
  registers_.set(reg::torque,
                 fed_back ? registers_.get(reg::torque_setting) / 1000 * servo_.rated_torque : 0);
  publish_pulses();
}

/// Encoder counts (table 2-4-4).
void Axis::publish_pulses() {
  const double scale = registers_.get(reg::ppr) / pulses_of_a_turn();
  registers_.set(reg::set_pulses, state_.position * scale);
  registers_.set(reg::feedback_pulses, feedback_ * scale);
  registers_.set(reg::offset_pulses, (feedback_ - start_) * scale);
  published_ = feedback_;
}

// ---- for its picture ----

void Axis::note(Time now, std::string what) {
  recorder_.tell(now);
  recorder_.note(std::move(what));
}

void Axis::record(double speed, Duration period) {
  if (speed != 0 && !recorder_.has_moved()) limits_ = limits();
  recorder_.add(feedback_, speed, period);
}

void Axis::note_edges(const Signals& now) {
  const Signals before = noted_.value_or(now);
  noted_ = now;
  const auto edge = [&](bool is, bool was, const char* name) {
    if (is != was) recorder_.note(std::string(name) + (is ? " on" : " off"));
  };
  edge(now.min, before.min, "min limit switch");
  edge(now.max, before.max, "max limit switch");
  edge(now.close, before.close, "close signal");
  edge(now.origin, before.origin, "origin switch");
}

/// As far as somebody has set them; a homing later on moves the switches, not the axis.
std::vector<AxisTrace::Limit> Axis::limits() const {
  std::vector<AxisTrace::Limit> found;
  for (const Register& one : {reg::min_limit, reg::max_limit})
    if (const double at = registers_.get(one); at != one.initial)
      found.push_back({std::string(one.name), at, at});
  const double sign = registers_.get(reg::direction) != 0 ? -1 : 1;
  const auto add = [&](const Register& role, const char* name) {
    const Terminal where = terminal(role);
    for (const Switch& one : servo_.switches) {
      if (!where.input || one.terminal != *where.input) continue;
      const double one_end = sign * one.from - machine_, other = sign * one.to - machine_;
      found.push_back({name, std::min(one_end, other), std::max(one_end, other)});
    }
  };
  add(reg::min_terminal, "min limit switch");
  add(reg::max_terminal, "max limit switch");
  add(reg::close_terminal, "close signal");
  add(reg::origin_terminal, "origin switch");
  return found;
}

std::optional<AxisTrace> Axis::trace(Time now) const {
  if (!recorder_.has_moved()) return std::nullopt;
  return AxisTrace{std::to_string(number()), recorder_.samples(now), recorder_.events(), limits_};
}

void Axis::restart() {
  disable();
  refused_ = cut_ = quiet_ = false;
  changes_.clear();
  for (const Register& one : axis_registers())
    if (one.area == "SM" || one.area == "SD") registers_.set(one, 0);
}

}  // namespace fieldproof::xnet
