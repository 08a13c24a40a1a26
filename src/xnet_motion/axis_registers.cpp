#include "src/xnet_motion/axis_registers.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace fieldproof::xnet {

namespace {

constexpr std::array all{reg::enabled,
                         reg::running,
                         reg::completed,
                         reg::error_flag,
                         reg::at_min,
                         reg::at_max,
                         reg::bound,
                         reg::enable,
                         reg::jog_forward,
                         reg::jog_reverse,
                         reg::clear_alarm,
                         reg::home_forward,
                         reg::home_reverse,
                         reg::full_loop,
                         reg::slow_stop,
                         reg::simulation,
                         reg::status,
                         reg::error,
                         reg::bus_errors,
                         reg::offset,
                         reg::position,
                         reg::speed,
                         reg::set_speed,
                         reg::loop_position,
                         reg::segment,
                         reg::torque,
                         reg::torque_setting,
                         reg::reverse_torque,
                         reg::torque_mode,
                         reg::torque_feedback,
                         reg::target,
                         reg::speed_setting,
                         reg::acceleration,
                         reg::deceleration,
                         reg::ratio,
                         reg::jog_step,
                         reg::jog_speed,
                         reg::width,
                         reg::gain,
                         reg::filter,
                         reg::set_pulses,
                         reg::feedback_pulses,
                         reg::offset_pulses,
                         reg::loop_pulses,
                         reg::mode,
                         reg::encoder,
                         reg::ppr,
                         reg::per_turn,
                         reg::loop_numerator,
                         reg::origin,
                         reg::min_limit,
                         reg::max_limit,
                         reg::max_speed,
                         reg::least_acceleration,
                         reg::least_deceleration,
                         reg::first_jog_step,
                         reg::first_jog_speed,
                         reg::loop_counter,
                         reg::deviation,
                         reg::min_terminal,
                         reg::max_terminal,
                         reg::close_terminal,
                         reg::origin_terminal,
                         reg::home_mode,
                         reg::home_high,
                         reg::home_low,
                         reg::home_creep,
                         reg::direction,
                         reg::first_width,
                         reg::first_gain,
                         reg::loop_deviation};

unsigned words_of(Kind kind) {
  switch (kind) {
    case Kind::coil:
    case Kind::word: return 1;
    case Kind::qword: return 4;
    default: return 2;
  }
}

double number_at(const std::uint16_t* words, Kind kind) {
  if (kind == Kind::coil) return *words;
  const unsigned count = words_of(kind);
  std::uint64_t raw = 0;
  for (unsigned i = 0; i < count; ++i) raw |= std::uint64_t{words[i]} << (16 * i);
  if (kind == Kind::floating) return std::bit_cast<float>(static_cast<std::uint32_t>(raw));
  const unsigned unused = 64 - 16 * count;
  return static_cast<double>(static_cast<std::int64_t>(raw << unused) >> unused);
}

void put_number(std::uint16_t* words, Kind kind, double value) {
  const std::uint64_t raw = kind == Kind::floating
                                ? std::bit_cast<std::uint32_t>(static_cast<float>(value))
                                : static_cast<std::uint64_t>(std::llround(value));
  for (unsigned i = 0; i < words_of(kind); ++i)
    words[i] = static_cast<std::uint16_t>(raw >> (16 * i) & 0xFFFF);
}

}  // namespace

std::uint32_t stride_of(std::string_view area) { return area == "SD" || area == "SFD" ? 60 : 20; }

std::span<const Register> axis_registers() { return all; }

double read_number(const Memory& memory, const Component& first, Kind kind) {
  std::array<std::uint16_t, 4> words{};
  for (unsigned i = 0; i < words_of(kind); ++i)
    words[i] = memory.read({first.area, first.number + i});
  return number_at(words.data(), kind);
}

void write_number(Memory& memory, const Component& first, Kind kind, double value) {
  std::array<std::uint16_t, 4> words{};
  put_number(words.data(), kind, value);
  for (unsigned i = 0; i < words_of(kind); ++i)
    memory.write({first.area, first.number + i}, words[i]);
}

AxisRegisters::AxisRegisters(Memory& memory, unsigned axis) : axis_(axis) {
  constexpr std::array<std::string_view, 4> names{"SM", "SD", "HSD", "SFD"};
  for (std::size_t i = 0; i < names.size(); ++i)
    banks_[i] = memory.body(area_named(names[i])) + stride_of(names[i]) * (axis - 1);
}

double AxisRegisters::get(const Register& one) const { return number_at(place(one), one.kind); }
void AxisRegisters::set(const Register& one, double value) {
  put_number(place(one), one.kind, value);
}

bool AxisRegisters::take(const Register& coil) {
  const bool was_on = on(coil);
  if (was_on) set(coil, 0);
  return was_on;
}

void AxisRegisters::initialise() {
  for (const Register& one : all)
    if (one.initial != 0) set(one, one.initial);
}

}  // namespace fieldproof::xnet
