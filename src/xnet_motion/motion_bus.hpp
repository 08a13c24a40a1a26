// The motion bus of one PLC: its axes on given time, and the instructions of X-NET 2-2 as lines of
// text that read like the manual.
#pragma once

#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "src/base/result.hpp"
#include "src/xnet_motion/axis.hpp"

namespace fieldproof::xnet {

/// 2-2
enum class MotionInstruction { moto, motoa, motos, mostop, mogoon, mosyn, mousyn, mowrite, moread };

class MotionBus {
 public:
  /// Twenty axes, those without a servo disconnected. `memory`: of its PLC, which outlives it.
  /// `slaves`: 10, or 20 (SFD2991, and SFD2990 with it).
  MotionBus(Memory& memory, std::vector<Servo> servos, unsigned slaves = 10);

  /// The end of the present refresh period (SFD2990); what it is told acts from there on.
  Time wake_at() const { return next_; }
  void advance(Time now, bool run);

  /// Is it an instruction of the motion bus, or an action of a servo?
  static bool knows(std::string_view action);
  /// "MOTO 10000 5000 50 axis 1" (operands also registers: D0), "MOTOS D0 D1000 axis 1",
  /// "MOSTOP -1 axis 1", "MOGOON axis 1", "MOSYN 0.5 master 1 slave 4", "MOUSYN axis 4",
  /// "MOWRITE D0 axis 1", "MOREAD D0 axis 1"; "servo 1 alarm", "stuck alarm", "well", "off", "on",
  /// "stall", "free", "enable", "disable", "push 500", "have 3 sync errors" (data, crc, uart), one
  /// in each refresh period. Errors name the word: the text is wrong.
  /// What is wrong with the motion stands in SD2002.
  Status act(std::string_view action);
  /// What is wrong with such a text, before there is a bus; `memory`: of a PLC of its model.
  static Status check(std::string_view action, const Memory& memory);

  /// What a servo shows: "U0-62 of servo 1" (2-6-2). Nothing: there is no such thing.
  std::optional<unsigned> count(std::string_view text) const;
  /// Is it such a thing, of any servo that there can be?
  static bool is_counter(std::string_view text);

  /// Power is gone and back.
  void restart();

  /// Of the axes that moved.
  std::vector<AxisTrace> trace(Time now) const;

 private:
  struct Binding {
    int master = 1;  // an axis; -1 to -4: HSC0, HSC2, HSC4, HSC6
    unsigned slave = 1;
    double seen = 0;  // where the master was
  };
  struct Order;
  static Result<Order> read(std::string_view action, const Memory& memory);
  Status act_on_servo(std::string_view action);
  void execute(const Order& order, Time now);
  void move_segments(const Order& order, Axis& axis, Time now);
  void bind(const Order& order);
  bool follows(int axis, unsigned master) const;
  double place_of(int master) const;
  void follow(Time now, Duration period);
  double operand(std::string_view word, bool floating) const;
  Axis* find(unsigned number) const;

  Memory& memory_;
  const std::uint16_t* settings_;  // SFD
  std::vector<std::unique_ptr<Axis>> axes_;
  std::vector<Binding> bindings_;
  bool downloads_ = false;  // 2-3-7: it runs no instruction
  bool begun_ = false;      // it is told the time by the first advance
  Time next_{};             // refresh
  std::uint64_t touched_ = 0;
  bool ran_ = false;
};

}  // namespace fieldproof::xnet
