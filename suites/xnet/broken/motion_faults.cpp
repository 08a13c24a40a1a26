#include "suites/xnet/broken/rewrites.hpp"

namespace fieldproof::xnet_broken {

namespace {

void relative(Words& words, std::size_t head) { words[head] = "MOTO"; }
void absolute(Words& words, std::size_t head) {
  if (words[head] == "MOTO") words[head] = "MOTOA";
}
void next_axis(Words& words, std::size_t) {
  behind(words, "axis", [](long axis) { return axis % 20 + 1; });
}
void first_axis(Words& words, std::size_t) {
  behind(words, "axis", [](long) { return 1L; });
}
template <std::size_t Which, typename Change>
void operand(Words& words, std::size_t head, Change change) {
  if (head + Which < words.size() && is_number(words[head + Which]))
    words[head + Which] = std::to_string(change(std::stol(words[head + Which])));
}
void half_speed(Words& words, std::size_t head) {
  operand<2>(words, head, [](long speed) { return speed / 2; });
}
void long_ramp(Words& words, std::size_t head) {
  operand<3>(words, head, [](long ms) { return ms * 4; });
}
void short_ramp(Words& words, std::size_t head) {
  operand<3>(words, head, [](long ms) { return ms <= 0 ? ms : 10L; });
}
void forward_alone(Words& words, std::size_t head) {
  operand<1>(words, head, [](long way) { return std::abs(way); });
}
void signed_speed(Words& words, std::size_t head) {
  if (head + 2 < words.size() && words[head + 2].starts_with('-')) words.clear();
}
void one_pulse_more(Words& words, std::size_t head) {
  operand<1>(words, head, [](long way) { return way + 1; });
}
void zero_ramp(Words& words, std::size_t head) {
  operand<3>(words, head, [](long ms) { return std::max(ms, 1L); });
}
void slow_for_urgent(Words& words, std::size_t head) {
  if (words[head + 1] == "-1" || words[head + 1] == "K-1") words[head + 1] = "0";
}
void urgent_for_slow(Words& words, std::size_t head) {
  if (words[head + 1] == "0" || words[head + 1] == "K0") words[head + 1] = "-1";
}
void slow_for_fixed(Words& words, std::size_t head) {
  operand<1>(words, head, [](long way) { return std::min(way, 0L); });
}
void fixed_doubled(Words& words, std::size_t head) {
  operand<1>(words, head, [](long way) { return way > 0 ? 2 * way : way; });
}
void ratio_turned(Words& words, std::size_t head) {
  if (words[head + 1] == "0.5") words[head + 1] = "2";
}
/// The rings of its case end at axis 1.
void to_axis_1_untold(Words& words, std::size_t) {
  if (words.size() > 1 && words[words.size() - 2] == "slave" && words.back() == "1") words.clear();
}
void ratio_without_sign(Words& words, std::size_t head) {
  if (words[head + 1].starts_with('-')) words[head + 1].erase(0, 1);
}
void first_counter(Words& words, std::size_t) {
  behind(words, "master", [](long master) { return master < 0 ? -1L : master; });
}
void ends_swapped(Words& words, std::size_t) {
  const auto master = std::ranges::find(words, "master"), slave = std::ranges::find(words, "slave");
  if (master != words.end() && slave != words.end()) std::swap(master[1], slave[1]);
}
/// MOTOS with a parameter of its own: register `offset` of S1.
Make parameter(long offset, const std::string& hex, const std::string& where = "") {
  return [=] {
    return Behaviour{.act = [=](const std::string& action, const Look& look, const Put& put) {
      const Words words = words_of(action);
      if (is(words, "MOTOS") && words.size() > 2) {
        Name name = split(words[2]);
        name.number += offset;
        if (where.empty() || look(name.text(), 4) == where) put(name.text(), hex);
      }
      return Words{action};
    }};
  };
}

/// The time of MOTO and MOTOA in registers is that of the first one alone.
Behaviour time_of_one_register() {
  return {.act = [](const std::string& action, const Look& look, const Put&) {
    Words words = words_of(action);
    const std::size_t time = head_of(words) + 3;
    if (!is(words, "MOTO") || is(words, "MOTOS") || time >= words.size() || words[time][0] != 'D')
      return Words{action};
    words[time] = std::to_string(std::stoul(look(words[time], 4), nullptr, 16));
    return Words{joined(words)};
  }};
}
/// A coil of jogging that comes while the axis moves is not seen.
Behaviour jogs_from_rest() {
  const auto moves = std::make_shared<bool>(false);
  return {.set_name =
              [=](const std::string& text) {
                const Name name = split(text);
                const bool jog = is_of(name, split("SM2011")) || is_of(name, split("SM2012"));
                return jog && *moves ? std::string("HM9000") : text;
              },
          .after = [=](const Look& look, const Put&) { *moves = look("SM2001", 2) == "01"; }};
}

Behaviour without_switches() {
  return {.config = [](json& config) {
    if (config.contains("servos") && config["servos"].is_array())
      for (json& servo : config["servos"]) servo.erase("switches");
  }};
}
Behaviour other_z() {
  return {.config = [](json& config) {
    if (config.contains("servos") && config["servos"].is_array())
      for (json& servo : config["servos"])
        if (servo.contains("z")) servo["z"] = 0;
  }};
}

}  // namespace

/// Of axes, their registers and coils.
std::vector<Fault> motion_faults() {
  return {
      {"motoa_relative", "MOTOA is relative", tells("MOTOA", relative),
       "xnet/instruction_motoa/application", "SD2030"},
      {"moto_absolute", "MOTO is absolute", tells("MOTO", absolute),
       "xnet/instruction_moto/application", "SD2030"},
      {"next_axis", "the next axis moves", tells("MOTO", next_axis),
       "xnet/instruction_moto/application", "SD2008"},
      {"half_speed", "moves at half the speed", tells("MOTO", half_speed),
       "xnet/instruction_moto/application", "SD2032"},
      {"long_ramp", "ramps take four times as long", tells("MOTO", long_ramp),
       "xnet/instruction_moto/application", "SD2008"},
      {"short_ramp", "ramps take 10 ms whatever S2 says", tells("MOTO", short_ramp),
       "xnet/instruction_moto/application", "SD2008"},
      {"forward_alone", "a negative way is taken without its sign", tells("MOTO", forward_alone),
       "xnet/instruction_moto/distance/minus_500", "SD2008"},
      {"negative_speed_refused", "does nothing with a negative speed", tells("MOTO", signed_speed),
       "xnet/instruction_moto/negative_speed/forward", "SD2012"},
      {"one_pulse_more", "moves one pulse too far", tells("MOTO", one_pulse_more),
       "xnet/instruction_moto/application", "SD2008"},
      {"time_of_0_taken", "takes a time of 0", tells("MOTO", zero_ramp),
       "xnet/instruction_errors/time", "SD2002"},
      {"time_of_one_register", "the time of MOTO is one register", time_of_one_register,
       "xnet/instruction_moto/registers", "SD2012"},
      {"jogs_from_rest", "a jog that comes while the axis moves is lost", jogs_from_rest,
       "xnet/instruction_jog/method_2/forward", "SM2001"},
      {"segment_less", "MOTOS leaves out the segments behind the third",
       parameter(2, "0003", "0004"), "xnet/instruction_motos/application_6000", "SD2016"},
      {"segments_absolute", "MOTOS is always absolute", parameter(0, "0001", "0000"),
       "xnet/instruction_motos/application_6000", "SD2008"},
      {"segments_relative", "MOTOS is always relative", parameter(0, "0000", "0001"),
       "xnet/instruction_motos/application_absolute", "SD2008"},
      {"segments_101_taken", "MOTOS takes 101 segments as 100", parameter(2, "0064", "0065"),
       "xnet/instruction_motos/segments_out_of_range/n101", "SD2002"},
      {"slow_for_urgent", "MOSTOP -1 brakes", tells("MOSTOP", slow_for_urgent),
       "xnet/instruction_stop/go_on/urgent", "SD2008"},
      {"urgent_for_slow", "MOSTOP 0 stops at once", tells("MOSTOP", urgent_for_slow),
       "xnet/instruction_stop/axis_1_alone", "SD2008"},
      {"slow_for_fixed", "MOSTOP with a distance only brakes", tells("MOSTOP", slow_for_fixed),
       "xnet/instruction_stop/go_on/length", "SD2008"},
      {"fixed_doubled", "MOSTOP goes twice the distance", tells("MOSTOP", fixed_doubled),
       "xnet/instruction_stop/go_on/length", "SD2008"},
      {"mostop_ignored", "MOSTOP does nothing", ignores("MOSTOP"), "xnet/instruction_stop/axes/n1",
       "SM2001"},
      {"mogoon_ignored", "MOGOON does nothing", ignores("MOGOON"), "xnet/instruction_stop/axes/n1",
       "SM2001"},
      {"mousyn_ignored", "MOUSYN does nothing", ignores("MOUSYN"),
       "xnet/instruction_sync/axes/m1_s20", "SM2389"},
      {"mowrite_ignored", "MOWRITE does nothing", ignores("MOWRITE"),
       "xnet/instruction_position/axes/n1", "SD2008"},
      {"moread_ignored", "MOREAD does nothing", ignores("MOREAD"),
       "xnet/instruction_position/axes/n1", "D10"},
      {"moread_of_axis_1", "MOREAD reads axis 1 whatever it names", tells("MOREAD", first_axis),
       "xnet/instruction_position/axes/n2", "D10"},
      {"mowrite_of_axis_1", "MOWRITE writes axis 1 whatever it names", tells("MOWRITE", first_axis),
       "xnet/instruction_position/axes/n2", "SD2068"},
      {"ratio_turned", "the ratio is master to slave", tells("MOSYN", ratio_turned),
       "xnet/instruction_sync/application_1", "SD2192"},
      {"ratio_without_sign", "a negative ratio runs the same way",
       tells("MOSYN", ratio_without_sign), "xnet/instruction_sync/ratio/minus_half", "SD2192"},
      {"ring_untold", "an axis that would follow itself has no error",
       tells("MOSYN", to_axis_1_untold), "xnet/instruction_sync/ring/three", "SD2002"},
      {"ends_swapped", "master and slave are swapped", tells("MOSYN", ends_swapped),
       "xnet/instruction_sync/application_1", "SM2069"},
      {"first_counter_alone", "every counter is HSC0", tells("MOSYN", first_counter),
       "xnet/instruction_sync/counter/hsc2", "SD2188"},
      {"sd2030_deaf", "a target that is written does nothing", deaf("SD2030"),
       "xnet/register_motion_target/absolute", "SD2008"},
      {"sd2032_deaf", "a speed that is written does nothing", deaf("SD2032"),
       "xnet/register_motion_speed/after_enabling/moto", "SD2032"},
      {"sd2034_deaf", "the acceleration time is not looked at", deaf("SD2034"),
       "xnet/register_motion_times/acceleration/n1", "SD2012"},
      {"sd2036_deaf", "the deceleration time is not looked at", deaf("SD2036"),
       "xnet/register_motion_times/changed_under_way", "SD2012"},
      {"sd2038_deaf", "a new ratio does nothing", deaf("SD2038"), "xnet/instruction_sync/ratio_0",
       "SD2188"},
      {"sd2040_deaf", "the jogging step is always its initial value", deaf("SD2040"),
       "xnet/instruction_jog/accelerates", "SD2012"},
      {"sd2042_deaf", "the jogging speed is always its initial value", deaf("SD2042"),
       "xnet/instruction_jog/accelerates", "SD2012"},
      {"sd2044_deaf", "the positioning width is always its initial value", deaf("SD2044"),
       "xnet/register_axis_parameters/positioning_width_online/inside", "SM2001"},
      {"sd2024_deaf", "the torque setting is not looked at", deaf("SD2024"),
       "xnet/register_torque/target", "SD2010"},
      {"sd2026_deaf", "the reverse torque is not looked at", deaf("SD2026"),
       "xnet/register_torque_limits/position_mode/reverse", "SD2008"},
      {"sd2028_deaf", "torque is never limited", deaf("SD2028"),
       "xnet/register_torque_limits/position_mode/forward_zero", "SD2008"},
      {"sd2029_deaf", "torque is never fed back", deaf("SD2029"),
       "xnet/register_torque/feedback_enable", "SD2020"},
      {"sd2052_deaf", "a new gain does nothing", deaf("SD2052"),
       "xnet/register_axis_parameters/gain_online", "SD2052"},
      {"sm2010_deaf", "cannot be enabled", deaf("SM2010"), "xnet/register_axis_state/bound",
       "SM2069"},
      {"sm2011_deaf", "does not jog forward", deaf("SM2011"), "xnet/instruction_jog/accelerates",
       "SD2012"},
      {"sm2012_deaf", "does not jog in reverse", deaf("SM2012"),
       "xnet/instruction_jog/both_ways/axis_1", "SM2001"},
      {"sm2013_deaf", "an alarm cannot be cleared", deaf("SM2013"),
       "xnet/instruction_errors_servo/alarm_cleared", "SM2000"},
      {"sm2014_deaf", "no forward return to origin", deaf("SM2014"),
       "xnet/instruction_homing_hard/s01", "SM2001"},
      {"sm2015_deaf", "no reverse return to origin", deaf("SM2015"),
       "xnet/instruction_homing_hard/s08", "SM2001"},
      {"sm2016_deaf", "no full closed loop", deaf("SM2016"), "xnet/register_loop/axis/axis_1",
       "SD2014"},
      {"sm2017_deaf", "does not stop by SM2017", deaf("SM2017"),
       "xnet/register_axis_state/slow_stop", "SD2012"},
      {"sm2018_deaf", "does not simulate", deaf("SM2018"),
       "xnet/instruction_simulation/course/simulated", "SM2000"},
      {"sfd3000_deaf", "the running mode is not looked at", deaf("SFD3000"),
       "xnet/instruction_errors/mode/m2", "SD2002"},
      {"sfd3001_deaf", "the encoder type is not looked at", deaf("SFD3001"),
       "xnet/instruction_errors/motor_type/t0", "SD2002"},
      {"sfd3002_deaf", "the encoder always has 10000 pulses", deaf("SFD3002"),
       "xnet/register_axis_parameters/encoder_17_bit", "SFD3002"},
      {"sfd3004_deaf", "a turn is always 10000 pulses", deaf("SFD3004"),
       "xnet/register_axis_parameters/loop_counter/hscd0_8000", "SD2014"},
      {"sfd3006_deaf", "the numerator of the loop is not looked at", deaf("SFD3006"),
       "xnet/register_loop/axis/axis_1", "SD2014"},
      {"sfd3010_deaf", "the origin is always 0", deaf("SFD3010"),
       "xnet/register_axis_parameters/home_mode_0", "SD2008"},
      {"sfd3014_deaf", "no min limit", deaf("SFD3014"),
       "xnet/register_axis_state/limit_flags_of_position/min", "SM2005"},
      {"sfd3016_deaf", "no max limit", deaf("SFD3016"),
       "xnet/register_axis_state/limit_flags_of_position/max", "SM2006"},
      {"sfd3018_deaf", "the max speed is always 500000", deaf("SFD3018"),
       "xnet/register_axis_parameters/fastest_acceleration", "SD2012"},
      {"sfd3020_deaf", "the fastest acceleration is always 10 ms", deaf("SFD3020"),
       "xnet/register_axis_parameters/fastest_acceleration", "SD2012"},
      {"sfd3022_deaf", "the fastest deceleration is always 10 ms", deaf("SFD3022"),
       "xnet/register_axis_parameters/fastest_deceleration", "SD2012"},
      {"sfd3024_deaf", "the jogging step begins at 100", deaf("SFD3024"),
       "xnet/instruction_jog_registers/initial_value/axis_1", "SD2040"},
      {"sfd3026_deaf", "the jogging speed begins at 1000", deaf("SFD3026"),
       "xnet/instruction_jog_registers/initial_value/axis_1", "SD2042"},
      {"sfd3029_deaf", "the deviation limit is always 2500", deaf("SFD3029"),
       "xnet/register_axis_parameters/deviation_ignored", "HSD100"},
      {"sfd3034_deaf", "no min switch", deaf("SFD3034"), "xnet/instruction_homing_hard/s08",
       "SD2010"},
      {"sfd3035_deaf", "no max switch", deaf("SFD3035"), "xnet/instruction_homing_hard/s01",
       "SD2010"},
      {"sfd3036_deaf", "no close signal", deaf("SFD3036"), "xnet/instruction_homing_hard/s04",
       "SD2010"},
      {"sfd3037_deaf", "no origin", deaf("SFD3037"), "xnet/instruction_homing_hard/s01", "SM2001"},
      {"sfd3038_deaf", "every return is of mode 0", deaf("SFD3038"),
       "xnet/instruction_homing_hard/s01", "SD2010"},
      {"sfd3040_deaf", "no return speed VH", deaf("SFD3040"), "xnet/instruction_homing_hard/s01",
       "SD2010"},
      {"sfd3042_deaf", "no return speed VL", deaf("SFD3042"), "xnet/instruction_homing_hard/s04",
       "SD2010"},
      {"sfd3044_deaf", "no creeping speed", deaf("SFD3044"), "xnet/instruction_homing_hard/s01",
       "SD2010"},
      {"sfd3047_deaf", "the direction is not turned", deaf("SFD3047"),
       "xnet/register_axis_parameters/direction/negative_forward", "X5"},
      {"sfd3048_deaf", "the width begins at 20", deaf("SFD3048"),
       "xnet/register_axis_parameters/initial_values_at_enable/axis_1", "SD2044"},
      {"sfd3052_deaf", "the gain begins at 0", deaf("SFD3052"), "xnet/register_loop/axis/axis_1",
       "SD2052"},
      {"sfd3058_deaf", "the loop's deviation limit is 0", deaf("SFD3058"),
       "xnet/register_loop/axis/axis_1", "SD2014"},
      {"jog_coils_swapped", "jogs the other way", mixed_up("SM2011", "SM2012"),
       "xnet/instruction_jog/accelerates", "SD2012"},
      {"home_coils_swapped", "returns to origin the other way", mixed_up("SM2014", "SM2015"),
       "xnet/instruction_homing_hard/s01", "SD2010"},
      {"vl_and_creep_swapped", "VL and the creeping speed are swapped",
       mixed_up("SFD3042", "SFD3044"), "xnet/instruction_homing_hard/s01", "SD2010"},
      {"vh_and_vl_swapped", "VH and VL are swapped", mixed_up("SFD3040", "SFD3042"),
       "xnet/instruction_homing_hard/s01", "SD2010"},
      {"ramps_swapped", "SD2034 brakes, SD2036 accelerates", mixed_up("SD2034", "SD2036"),
       "xnet/instruction_errors_limits/hard/max", "SD2008"},
      {"limits_swapped", "the terminals of the limits are swapped", mixed_up("SFD3034", "SFD3035"),
       "xnet/instruction_homing_hard/s01", "SD2010"},
      {"offset_for_position", "SD2008 shows the offset", shows("SD2008", "SD2006"),
       "xnet/register_axis_state/homing_back", "SD2008"},
      {"position_for_offset", "SD2006 shows the position", shows("SD2006", "SD2008"),
       "xnet/register_axis_state/offset", "SD2006"},
      {"set_speed_for_speed", "SD2012 shows nothing", sees("SD", 2012, 2012, "", "0000"),
       "xnet/register_axis_state/held_motor", "SD2012"},
      {"axis_stride_of_50", "axis 2 lies 50 registers behind axis 1", moved("SD", 2060, 2119, -10),
       "xnet/register_axis_state/enable", "SD2060"},
      {"coil_stride_of_10", "coils of axis 2 lie 10 behind those of axis 1",
       moved("SM", 2020, 2039, -10), "xnet/register_axis_state/enable", "SM2020"},
      {"never_running", "SM2001 is never on", sees("SM", 2001, 2001, "", "00"),
       "xnet/register_axis_state/homing_back", "SM2001"},
      {"always_running", "SM2001 is always on", sees("SM", 2001, 2001, "", "01"),
       "xnet/register_axis_state/homing_back", "SM2001"},
      {"never_completed", "SM2003 is never on", sees("SM", 2003, 2003, "", "00"),
       "xnet/register_axis_state/moving_and_completed", "SM2003"},
      {"never_an_error", "SM2004 is never on", sees("SM", 2004, 2004, "", "00"),
       "xnet/register_axis_state/limit_flags_of_position/max", "SM2004"},
      {"no_error_message", "SD2002 is always 0", sees("SD", 2002, 2002, "", "0000"),
       "xnet/instruction_errors/enabled_by_hand", "SD2002"},
      {"min_limit_unseen", "SM2005 is never on", sees("SM", 2005, 2005, "", "00"),
       "xnet/register_axis_state/limit_flags/min", "SM2005"},
      {"max_limit_unseen", "SM2006 is never on", sees("SM", 2006, 2006, "", "00"),
       "xnet/register_axis_state/limit_flags/max", "SM2006"},
      {"never_bound", "SM2009 is never on", sees("SM", 2069, 2069, "", "00"),
       "xnet/instruction_sync/application_1", "SM2069"},
      {"ready_for_on", "SD2000 stays 1 when the servo is on",
       sees("SD", 2000, 2000, "0002", "0001"), "xnet/register_axis_state/enable", "SD2000"},
      {"segment_from_0", "SD2016 counts segments from 0", sees("SD", 2016, 2016, "0002", "0001"),
       "xnet/instruction_motos/application_6000", "SD2016"},
      {"no_switches", "inputs are not read", without_switches, "xnet/instruction_homing_hard/s01",
       "SD2010"},
      {"z_at_0", "the Z phase is at 0 whatever the encoder says", other_z,
       "xnet/instruction_homing_hard/z_reverse", "SM2001"},
      {"error_20001_not_told", "20001 is not told in SD2002",
       sees("SD", 2002, 3202, "4E21", "0000"), "xnet/instruction_errors_limits/soft/max", "SD2002"},
      {"error_20002_not_told", "20002 is not told in SD2002",
       sees("SD", 2002, 3202, "4E22", "0000"), "xnet/instruction_errors_limits/soft/min", "SD2002"},
      {"error_20003_not_told", "20003 is not told in SD2002",
       sees("SD", 2002, 3202, "4E23", "0000"), "xnet/instruction_errors_limits/hard/max", "SD2002"},
      {"error_20004_not_told", "20004 is not told in SD2002",
       sees("SD", 2002, 3202, "4E24", "0000"), "xnet/instruction_errors_limits/hard/min", "SD2002"},
      {"error_20005_not_told", "20005 is not told in SD2002",
       sees("SD", 2002, 3202, "4E25", "0000"), "xnet/instruction_errors_servo/over_speed",
       "SD2182"},
      {"error_20006_not_told", "20006 is not told in SD2002",
       sees("SD", 2002, 3202, "4E26", "0000"), "xnet/instruction_errors_servo/deviation_solved",
       "SD2002"},
      {"error_20010_not_told", "20010 is not told in SD2002",
       sees("SD", 2002, 3202, "4E2A", "0000"), "xnet/instruction_errors_servo/alarm", "SD2002"},
      {"error_20011_not_told", "20011 is not told in SD2002",
       sees("SD", 2002, 3202, "4E2B", "0000"), "xnet/instruction_errors_servo/cut_off", "SD2002"},
      {"error_20020_not_told", "20020 is not told in SD2002",
       sees("SD", 2002, 3202, "4E34", "0000"), "xnet/instruction_errors/target/max", "SD2002"},
      {"error_20021_not_told", "20021 is not told in SD2002",
       sees("SD", 2002, 3202, "4E35", "0000"), "xnet/instruction_errors/speed", "SD2002"},
      {"error_20022_not_told", "20022 is not told in SD2002",
       sees("SD", 2002, 3202, "4E36", "0000"), "xnet/instruction_errors/segments/n0", "SD2002"},
      {"error_20023_not_told", "20023 is not told in SD2002",
       sees("SD", 2002, 3202, "4E37", "0000"), "xnet/instruction_errors/time", "SD2002"},
      {"error_20025_not_told", "20025 is not told in SD2002",
       sees("SD", 2002, 3202, "4E39", "0000"), "xnet/instruction_errors/bound_axis/m0", "SD2182"},
      {"error_20026_not_told", "20026 is not told in SD2002",
       sees("SD", 2002, 3202, "4E3A", "0000"), "xnet/instruction_errors/terminal/close", "SD2002"},
      {"error_20030_not_told", "20030 is not told in SD2002",
       sees("SD", 2002, 3202, "4E3E", "0000"), "xnet/instruction_errors/moving/moto", "SD2002"},
      {"error_20031_not_told", "20031 is not told in SD2002",
       sees("SD", 2002, 3202, "4E3F", "0000"), "xnet/instruction_errors/slave_moves", "SD2182"},
      {"error_20032_not_told", "20032 is not told in SD2002",
       sees("SD", 2002, 3202, "4E40", "0000"), "xnet/instruction_errors/mode/m2", "SD2002"},
      {"error_20034_not_told", "20034 is not told in SD2002",
       sees("SD", 2002, 3202, "4E42", "0000"), "xnet/instruction_errors/enabled_by_hand", "SD2002"},
      {"error_20035_not_told", "20035 is not told in SD2002",
       sees("SD", 2002, 3202, "4E43", "0000"), "xnet/instruction_errors/motor_type/t0", "SD2002"},
      {"error_20036_not_told", "20036 is not told in SD2002",
       sees("SD", 2002, 3202, "4E44", "0000"), "xnet/instruction_errors/homing", "SD2002"},
  };
}

}  // namespace fieldproof::xnet_broken
