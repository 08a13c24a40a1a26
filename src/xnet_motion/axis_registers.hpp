// The registers and coils of one axis of the motion bus, N = 1 to 20: addresses of X-NET 2-4, 2-5.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "src/xnet/memory.hpp"

namespace fieldproof::xnet {

constexpr unsigned last_axis = 20;

/// How many registers, and what is in them; a coil.
enum class Kind { coil, word, dword, qword, floating };

/// Of axis 1; those of axis N are `stride` x (N - 1) further on: 60 in SD and SFD, 20 in HSD and
/// SM.
struct Register {
  std::string_view area;
  std::uint32_t first = 0;
  Kind kind = Kind::dword;
  std::string_view name;  // in facts
  double initial = 0;     // 2-4-1; else 0

  /// 0 to 3: SM, SD, HSD, SFD.
  constexpr std::size_t bank() const {
    if (area.size() == 2) return area[1] == 'M' ? 0 : 1;
    return area[0] == 'H' ? 2 : 3;
  }
};
std::uint32_t stride_of(std::string_view area);
std::span<const Register> axis_registers();

namespace reg {
// Table 2-4-5, 2-4-6
inline constexpr Register enabled{"SM", 2000, Kind::coil, "servo enable flag"};
inline constexpr Register running{"SM", 2001, Kind::coil, "moving flag"};
inline constexpr Register completed{"SM", 2003, Kind::coil, "instruction completed flag"};
inline constexpr Register error_flag{"SM", 2004, Kind::coil, "axis error flag"};
inline constexpr Register at_min{"SM", 2005, Kind::coil, "min position limit status"};
inline constexpr Register at_max{"SM", 2006, Kind::coil, "max position limit status"};
inline constexpr Register bound{"SM", 2009, Kind::coil, "slave axis binding flag"};
inline constexpr Register enable{"SM", 2010, Kind::coil, "servo enable"};
inline constexpr Register jog_forward{"SM", 2011, Kind::coil, "forward jogging"};
inline constexpr Register jog_reverse{"SM", 2012, Kind::coil, "reverse jogging"};
inline constexpr Register clear_alarm{"SM", 2013, Kind::coil, "clear the servo alarm"};
inline constexpr Register home_forward{"SM", 2014, Kind::coil, "forward return to origin"};
inline constexpr Register home_reverse{"SM", 2015, Kind::coil, "reverse return to origin"};
inline constexpr Register full_loop{"SM", 2016, Kind::coil, "full closed-loop enable"};
inline constexpr Register slow_stop{"SM", 2017, Kind::coil, "decelerate and stop"};
inline constexpr Register simulation{"SM", 2018, Kind::coil, "online simulation"};
// 2-5, table 2-4-2
inline constexpr Register status{"SD", 2000, Kind::dword, "servo status"};
inline constexpr Register error{"SD", 2002, Kind::dword, "error message"};
inline constexpr Register bus_errors{"SD", 2004, Kind::dword, "fieldbus communication error times"};
inline constexpr Register offset{"SD", 2006, Kind::dword, "present offset"};
inline constexpr Register position{"SD", 2008, Kind::dword, "present position"};
inline constexpr Register speed{"SD", 2010, Kind::dword, "present speed"};
inline constexpr Register set_speed{"SD", 2012, Kind::dword, "instantaneous speed"};
inline constexpr Register loop_position{"SD", 2014, Kind::dword, "full closed-loop position"};
inline constexpr Register segment{"SD", 2016, Kind::dword, "present segment"};
inline constexpr Register torque{"SD", 2020, Kind::floating, "present torque"};
inline constexpr Register torque_setting{"SD", 2024, Kind::dword, "torque setting"};
inline constexpr Register reverse_torque{"SD", 2026, Kind::dword, "reverse torque setting"};
inline constexpr Register torque_mode{"SD", 2028, Kind::word, "torque control mode"};
inline constexpr Register torque_feedback{"SD", 2029, Kind::word, "torque feedback enable"};
// Table 2-4-3
inline constexpr Register target{"SD", 2030, Kind::dword, "position setting"};
inline constexpr Register speed_setting{"SD", 2032, Kind::dword, "speed setting"};
inline constexpr Register acceleration{"SD", 2034, Kind::dword, "acceleration time setting"};
inline constexpr Register deceleration{"SD", 2036, Kind::dword, "deceleration time setting"};
inline constexpr Register ratio{"SD", 2038, Kind::floating, "synchronized motion speed ratio"};
inline constexpr Register jog_step{"SD", 2040, Kind::dword, "jogging step length"};
inline constexpr Register jog_speed{"SD", 2042, Kind::dword, "jogging speed"};
inline constexpr Register width{"SD", 2044, Kind::dword, "positioning finished width"};
inline constexpr Register gain{"SD", 2052, Kind::floating, "full closed-loop position gain"};
// Printed as 32 bits, the second word of which would be SD2000 of the next axis.
inline constexpr Register filter{"SD", 2059, Kind::word, "synchronized motion filter factor"};
// Table 2-4-4
inline constexpr Register set_pulses{"HSD", 100, Kind::qword, "target position setting pulses"};
inline constexpr Register feedback_pulses{"HSD", 104, Kind::qword, "feedback pulses"};
inline constexpr Register offset_pulses{"HSD", 108, Kind::qword, "present offset pulses"};
inline constexpr Register loop_pulses{"HSD", 112, Kind::qword, "full closed-loop feedback pulses"};
// Table 2-4-1
inline constexpr Register mode{"SFD", 3000, Kind::word, "running mode"};
inline constexpr Register encoder{"SFD", 3001, Kind::word, "motor encoder type", 1};
inline constexpr Register ppr{"SFD", 3002, Kind::dword, "encoder ppr", 10000};
inline constexpr Register per_turn{"SFD", 3004, Kind::dword, "moving distance per rotation", 10000};
inline constexpr Register loop_numerator{"SFD", 3006, Kind::word, "full closed-loop numerator"};
inline constexpr Register origin{"SFD", 3010, Kind::qword, "origin position"};
inline constexpr Register min_limit{"SFD", 3014, Kind::dword, "min position limit", -1e9};
inline constexpr Register max_limit{"SFD", 3016, Kind::dword, "max position limit", 1e9};
inline constexpr Register max_speed{"SFD", 3018, Kind::dword, "max speed limit", 500000};
inline constexpr Register least_acceleration{"SFD", 3020, Kind::dword, "fastest acceleration time",
                                             10};
inline constexpr Register least_deceleration{"SFD", 3022, Kind::dword, "fastest deceleration time",
                                             10};
inline constexpr Register first_jog_step{"SFD", 3024, Kind::dword, "jogging step initial value",
                                         100};
inline constexpr Register first_jog_speed{"SFD", 3026, Kind::dword, "jogging speed initial value",
                                          1000};
inline constexpr Register loop_counter{"SFD", 3028, Kind::word, "full closed-loop counter"};
inline constexpr Register deviation{"SFD", 3029, Kind::word, "position deviation limit", 2500};
inline constexpr Register min_terminal{"SFD", 3034, Kind::word, "min position limit terminal", 255};
inline constexpr Register max_terminal{"SFD", 3035, Kind::word, "max position limit terminal", 255};
inline constexpr Register close_terminal{"SFD", 3036, Kind::word, "close signal terminal", 255};
inline constexpr Register origin_terminal{"SFD", 3037, Kind::word, "origin terminal", 255};
inline constexpr Register home_mode{"SFD", 3038, Kind::word, "return to origin mode"};
inline constexpr Register home_high{"SFD", 3040, Kind::dword, "return speed VH"};
inline constexpr Register home_low{"SFD", 3042, Kind::dword, "return speed VL"};
inline constexpr Register home_creep{"SFD", 3044, Kind::dword, "creeping speed"};
inline constexpr Register direction{"SFD", 3047, Kind::word, "motion direction logic"};
inline constexpr Register first_width{"SFD", 3048, Kind::dword, "positioning width initial value",
                                      20};
inline constexpr Register first_gain{"SFD", 3052, Kind::floating, "position gain initial value"};
inline constexpr Register loop_deviation{"SFD", 3058, Kind::floating, "loop deviation limit"};
}  // namespace reg

/// Numbers in the memory of a PLC, the low word first.
double read_number(const Memory& memory, const Component& first, Kind kind);
void write_number(Memory& memory, const Component& first, Kind kind, double value);

/// Those of axis N in the memory of its PLC, which outlives it.
class AxisRegisters {
 public:
  AxisRegisters(Memory& memory, unsigned axis);

  unsigned axis() const { return axis_; }
  double get(const Register& one) const;
  void set(const Register& one, double value);
  bool on(const Register& coil) const { return get(coil) != 0; }
  /// Is it on? It is off from then on: "system will automatically reset" (table 2-4-6).
  bool take(const Register& coil);
  /// Table 2-4-1.
  void initialise();

 private:
  std::uint16_t* place(const Register& one) const { return banks_[one.bank()] + one.first; }
  std::array<std::uint16_t*, 4> banks_;  // of this axis: what is at 0 in it for axis 1
  unsigned axis_;
};

}  // namespace fieldproof::xnet
