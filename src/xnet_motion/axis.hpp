// One axis of the motion bus on given time: what instructions, registers and coils make of it
// (X-NET 2-2 to 2-5). It looks at its registers, and moves, once in each refresh period of the bus
// (SFD2990). What the manual is silent about: DECISIONS.md xnet/slopes and what follows there.
#pragma once

#include <algorithm>
#include <array>
#include <deque>
#include <optional>
#include <vector>

#include "src/xnet_motion/axis_recorder.hpp"
#include "src/xnet_motion/axis_registers.hpp"
#include "src/xnet_motion/homing.hpp"
#include "src/xnet_motion/path.hpp"
#include "src/xnet_motion/servo.hpp"

namespace fieldproof::xnet {

/// Messages in SD2002 (2-5).
enum class AxisError {
  none = 0,
  over_max = 20001,
  under_min = 20002,
  max_switch = 20003,
  min_switch = 20004,
  over_speed = 20005,
  deviation = 20006,
  servo_alarm = 20010,
  communication = 20011,
  target = 20020,
  speed = 20021,
  segments = 20022,
  time = 20023,
  bound_axis = 20025,
  home_terminal = 20026,
  not_ready = 20030,
  bound_not_ready = 20031,
  mode = 20032,
  enabled_already = 20034,
  encoder = 20035,
  home_failed = 20036
};

/// A row of the data of MOTOS (2-2-3).
struct Segment {
  double position = 0, speed = 0;
};

class Axis {
 public:
  /// `memory`: of its PLC, which outlives it.
  Axis(Memory& memory, Servo servo);

  unsigned number() const { return registers_.axis(); }
  Servo& servo() { return servo_; }
  double position() const { return state_.position; }
  /// Where its machine is: a position that is written, or found by homing, moves nothing.
  double place() const { return state_.position + machine_; }
  double speed() const { return state_.speed; }
  bool is_enabled() const { return enabled_; }
  bool is_moving() const { return doing_ != Doing::nothing || (bound_ && state_.speed != 0); }
  bool is_bound() const { return bound_; }
  /// The bus to its servo failed while it was enabled: 20011.
  bool was_cut() const { return cut_; }

  /// Nothing of it changes until somebody writes to its registers, or does something to its servo.
  bool is_quiet() const { return quiet_; }
  /// One refresh period. `run`: of the PLC. `slaves`: SFD2991.
  void refresh(Time now, Duration period, bool run, unsigned slaves);

  // Instructions, at their edge. What is wrong with one stands in SD2002, and nothing moves.
  void move(bool relative, double position, double speed, double ms, Time now);
  void move_segments(bool relative, std::vector<Segment> segments, double acceleration_ms,
                     double deceleration_ms, Time now);
  /// -1: at once; 0: as SD2036 says; above: in so many pulses (2-2-4).
  void stop(double how, Time now);
  void go_on(Time now);
  void write_position(double position);
  void fail(AxisError error);

  /// As a slave (2-2-6). `way` and `speed` are those of the master since it was told last.
  void bind(double ratio);
  void release();
  void follow(double way, double speed, Time now);

  /// Somebody turns the motor by force.
  void push(double pulses);
  /// Power is gone and back: what is not kept in flash is as at the start.
  void restart();

  /// For its picture: something is done to it now.
  void note(Time now, std::string what);
  /// How it moved until `now`; nothing: it did not.
  std::optional<AxisTrace> trace(Time now) const;

 private:
  enum class Doing { nothing, moving, segments, jogging, homing, finding_z, at_speed };

  void look_at_servo(bool run, unsigned slaves, Duration period);
  void enable();
  void disable();
  void stop_at_once();
  void look_at_coils(Time now);
  void jog(double sign, Time now);
  void home(double sign, Time now);
  void home_on(Time now);
  void find_z(double direction, Time now);
  void end_homing();
  void look_at_settings(Time now);
  void apply(const Register& setting, double value, Time now);
  void move_feedback();
  void move_switches();
  void look_at_limits();
  void look_at_loop(Time now);
  void turn_loop(bool on);
  void move_on(Time now);
  void next_segment(Time now);
  void keep_speed(Time now);
  void arrive();
  void plan(double target, Time now, double end_speed = 0);
  void begin(Doing doing);
  bool may_start();
  bool may_go(double target, double speed, double ms);
  double present_speed() const;
  void publish(double speed);
  void publish_pulses();
  void record(double speed, Duration period);
  void note_edges(const Signals& now);
  std::vector<AxisTrace::Limit> limits() const;
  void expect(const Register& setting, double value);
  void clear_error();
  /// Urgent stop, and no enable until SM2010 was off.
  void shut_off(AxisError error);

  // What a division needs is never 0.
  double max_speed() const { return std::max(registers_.get(reg::max_speed), 1.0); }
  double pulses_of_a_turn() const { return std::max(registers_.get(reg::per_turn), 1.0); }
  double slope(const Register& time, const Register& fastest) const;
  double steepest(double slope, const Register& fastest) const;
  /// From 0 to the max speed, in ms.
  double time_of(double slope) const { return max_speed() * 1000 / slope; }
  /// The slopes of SD2034 and SD2036.
  void take_ramps();
  /// Torque limits of 0 that way hold the shaft (2-3-2).
  bool is_held() const;
  /// The high speed counter of the full closed loop (SFD3028); nothing: there is none.
  std::optional<Component> loop_counter() const;
  /// Of SFD3034 to SFD3037: an input, or none; with its logic.
  struct Terminal {
    std::optional<unsigned> input;
    bool inverse = false, exists = true;
  };
  Terminal terminal(const Register& one) const;
  bool is_on(const Register& one) const;
  /// Where the machine is; SFD3047 turns the motor the other way.
  double machine_at(double position) const;
  Signals signals() const;

  Memory& memory_;
  std::uint16_t* inputs_;  // X
  AxisRegisters registers_;
  Servo servo_;
  State state_;          // as set
  double feedback_ = 0;  // where the motor is
  double machine_ = 0;   // where the machine is when the axis counts 0
  double start_ = 0;     // of the last motion
  double published_ = 0;
  Path path_;
  Doing doing_ = Doing::nothing;
  struct Checked {
    unsigned slaves = 0, refresh_us = 0;
    bool right = false;
  };
  Checked checked_;  // the parameters of the servo
  bool enabled_ = false, refused_ = false, bound_ = false, right_ = true, lost_ = false,
       cut_ = false;
  double goal_ = 0, speed_ = 1000, acceleration_ = 0, deceleration_ = 0;
  std::vector<Segment> segments_;  // absolute
  std::size_t segment_ = 0;
  double last_slope_ = 0;  // of the end of the segments
  bool simulates_ = false, quiet_ = false;
  struct Stopped {
    Doing doing = Doing::nothing;
    double goal = 0;
  };
  std::optional<Stopped> stopped_;  // by MOSTOP
  std::optional<Homing> homing_;

  std::array<double, 4> seen_{};  // SD2030 to SD2036 as the axis left them
  struct Change {
    std::size_t setting = 0;
    double value = 0;
    Time due{};
  };
  std::deque<Change> changes_;

  bool in_loop_ = false;
  double loop_shift_ = 0;
  std::optional<Time> loop_turns_;

  AxisRecorder recorder_;
  std::optional<Signals> noted_;          // as it was looked at last
  std::vector<AxisTrace::Limit> limits_;  // when it began to move
};

}  // namespace fieldproof::xnet
