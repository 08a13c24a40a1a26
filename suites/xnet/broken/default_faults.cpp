// Registers that hold something else than the manual prints where nobody has written yet, and what
// a special value of a register means.
#include "suites/xnet/broken/rewrites.hpp"

namespace fieldproof::xnet_broken {

namespace {

constexpr std::size_t digits_a_word = 4;

/// Where word `reg` of this axis stands in what begins at `name`; npos: not in it.
std::size_t place_of(const Name& name, const Name& reg, std::size_t digits) {
  for (long number = reg.number; number < reg.number + 20 * stride(reg.area);
       number += stride(reg.area)) {
    const long words = number - name.number;
    const auto at = static_cast<std::size_t>(words) * digits_a_word;
    if (name.area == reg.area && words >= 0 && at < digits) return at;
  }
  return std::string::npos;
}

/// A word of each axis is seen, or is set, as `to` where it is `from`.
std::string other_word(const std::string& text, std::string hex, const Name& reg,
                       const std::string& from, const std::string& to) {
  const std::size_t at = place_of(split(text), reg, hex.size());
  if (at != std::string::npos && hex.substr(at, digits_a_word) == from)
    hex.replace(at, digits_a_word, to);
  return hex;
}

Make holds(const std::string& reg, const std::string& from, const std::string& to) {
  return [=] {
    return Behaviour{.value = [=, word = split(reg)](const std::string& text, std::string hex) {
      return other_word(text, std::move(hex), word, from, to);
    }};
  };
}

Make takes(const std::string& reg, const std::string& from, const std::string& to) {
  return [=] {
    return Behaviour{.set_value = [=, word = split(reg)](const std::string& text, std::string hex) {
      return other_word(text, std::move(hex), word, from, to);
    }};
  };
}

}  // namespace

std::vector<Fault> default_faults() {
  return {
      {"twenty_axes_by_default", "SFD2991 is 20 where nobody has written",
       holds("SFD2991", "000A", "0014"), "xnet/register_axis_state/fresh", "SFD2991"},
      {"ten_axes_alone", "axes from the 11th on are never ready", sees("SD", 2600, 3199, "", "0"),
       "xnet/register_axis_state/twenty_ready", "SD2600"},
      {"speed_mode_by_default", "SFD3000 is 2 where it is 0", holds("SFD3000", "0000", "0002"),
       "xnet/register_speed/fresh", "SFD3000"},
      {"homing_to_z_by_default", "SFD3038 is 2 where it is 0", holds("SFD3038", "0000", "0002"),
       "xnet/configuration_homing/fresh", "SFD3034"},
      {"loop_gain_by_default", "SFD3052 is 1.0 where it is 0", holds("SFD3053", "0000", "3F80"),
       "xnet/register_loop/fresh", "SFD3052"},
      {"deviation_limit_by_default", "SFD3058 is 1.0 where it is 0",
       holds("SFD3059", "0000", "3F80"), "xnet/register_loop/fresh", "SFD3058"},
      {"jog_speed_by_default", "SFD3026 is 100 where it is 1000", holds("SFD3026", "03E8", "0064"),
       "xnet/instruction_jog_registers/fresh", "SFD3026"},
      {"no_terminal_is_x0", "0xFF in SFD3037 is taken for X0", takes("SFD3037", "00FF", "0000"),
       "xnet/register_axis_parameters/origin_no_terminal", "SD2008"},
      {"mask_of_two_bytes", "the mask is 255.255.0.0 where none was set",
       holds("SD1908", "FF00", "0000"), "xnet/register_ethernet/mask", "SD1908"},
  };
}

}  // namespace fieldproof::xnet_broken
