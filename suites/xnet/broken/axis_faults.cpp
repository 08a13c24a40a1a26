// Axes that do something wrong inside: what they are told is right, and what they make of it is
// not.
#include <cmath>
#include <memory>

#include "suites/xnet/broken/rewrites.hpp"

namespace fieldproof::xnet_broken {

namespace {

/// A double word, the low word first.
long number_in(const std::string& hex) {
  if (hex.size() < 8) return 0;
  const std::string high_first = hex.substr(4, 4) + hex.substr(0, 4);
  return static_cast<std::int32_t>(std::stoul(high_first, nullptr, 16));
}
std::string digits_of(long number) {
  const std::string high_first = fmt::format("{:08X}", static_cast<std::uint32_t>(number));
  return high_first.substr(4, 4) + high_first.substr(0, 4);
}
long read(const Look& look, const std::string& name) { return number_in(look(name, 8)); }

/// Double words of the axes have the high word first.
Behaviour words_swapped() {
  return {.value = [](const std::string& text, const std::string& hex) {
    const bool of_an_axis = split(text).area == "SD" && split(text).number >= 2000;
    return of_an_axis && hex.size() == 8 ? hex.substr(4) + hex.substr(0, 4) : hex;
  }};
}

/// Inputs and outputs lie eight further on: X0 is X10.
Behaviour octal_off_by_eight() {
  const auto off = [](const std::string& text) {
    Name name = split(text);
    if ((name.area == "X" || name.area == "Y") && name.number >= 0 && name.number < 70)
      name.number += 10;  // in octal
    return name.number < 0 ? text : name.text();
  };
  return {.look_name = off};
}

/// The limit itself, and one pulse more, are inside.
Make limit_one_late(const std::string& limit, long outward) {
  return [=] {
    return Behaviour{.set_value = [=](const std::string& text, const std::string& hex) {
      const bool is_it = is_of(split(text), split(limit)) && hex.size() == 8;
      return is_it ? digits_of(number_in(hex) + outward) : hex;
    }};
  };
}

/// The change between two segments, and the start, have the slope of the segment behind.
Behaviour acceleration_of_the_next_segment() {
  return {.act = [](const std::string& action, const Look& look, const Put& put) {
    const Words words = words_of(action);
    if (!is(words, "MOTOS")) return Words{action};
    const Name data = split(words.at(head_of(words) + 1)), to = split(words[head_of(words) + 2]);
    const auto at = [](Name name, long offset) {
      name.number += offset;
      return name.text();
    };
    const double first = static_cast<double>(read(look, at(data, 2)));
    const double next = static_cast<double>(read(look, at(data, 12)));
    if (read(look, at(to, 2)) > 1 && first > 0 && next > 0)
      put(at(to, 4), digits_of(std::lround(read(look, at(to, 4)) * first / next)));
    return Words{action};
  }};
}

/// What a fault remembers of its axis.
struct Told {
  long limit = 1'000'000'000;
  bool error = false;
};
/// A new device has a new axis.
auto forgets(const std::shared_ptr<Told>& told) {
  return [=](json&) { *told = {}; };
}

/// The code stands in SD2002 of axis 1, and SM2004 is on.
auto shows_error(const std::shared_ptr<Told>& told, long code) {
  return [=](const std::string& text, const std::string& hex) {
    if (!told->error) return hex;
    if (text == "SD2002") return digits_of(code);
    return text == "SM2004" ? std::string("01") : hex;
  };
}

/// 20021 is told, and the instruction is executed with the highest speed.
Behaviour error_20021_without_reaction() {
  const auto told = std::make_shared<Told>();
  return {.config = forgets(told),
          .act =
              [=](const std::string& action, const Look& look, const Put&) {
                Words words = words_of(action);
                if (!is(words, "MOTO") || is(words, "MOTOS")) return Words{action};
                std::string& speed = words[head_of(words) + 2];
                const long most = read(look, "SFD3018");
                told->error = is_number(speed) && std::stol(speed) > most;
                if (told->error) speed = std::to_string(most);
                return Words{joined(words)};
              },
          .value = shows_error(told, 20021)};
}

/// 20001 is told, and the axis goes on past the limit.
Behaviour error_20001_without_reaction() {
  const auto told = std::make_shared<Told>();
  const auto shown = shows_error(told, 20001);
  return {.config = forgets(told),
          .value =
              [=](const std::string& text, const std::string& hex) {
                return text == "SM2006" && told->error ? std::string("01") : shown(text, hex);
              },
          .set_value =
              [=](const std::string& text, const std::string& hex) {
                if (text != "SFD3016") return hex;
                told->limit = number_in(hex);
                return digits_of(1'000'000'000);
              },
          .after =
              [=](const Look& look, const Put&) {
                told->error = told->error || read(look, "SD2008") > told->limit;
              }};
}

}  // namespace

std::vector<Fault> axis_faults() {
  return {
      {"words_swapped", "double words of the axes have the high word first", words_swapped,
       "xnet/instruction_moto/application", "SD2008"},
      {"octal_off_by_eight", "inputs and outputs are eight further on", octal_off_by_eight,
       "xnet/instruction_data/bit_read_to/y7", "Y6"},
      {"max_limit_one_late", "one pulse past the max limit is inside", limit_one_late("SFD3016", 1),
       "xnet/instruction_errors/target/max", "SD2002"},
      {"min_limit_one_late", "one pulse past the min limit is inside",
       limit_one_late("SFD3014", -1), "xnet/instruction_errors/target/min", "SD2002"},
      {"acceleration_of_the_next_segment", "MOTOS has the slope of the segment behind",
       acceleration_of_the_next_segment, "xnet/instruction_motos/slope", "SD2012"},
      {"error_20021_without_reaction", "20021 is told, and the axis runs",
       error_20021_without_reaction, "xnet/instruction_errors/speed", "SM2001"},
      {"error_20001_without_reaction", "20001 is told, and the axis runs on",
       error_20001_without_reaction, "xnet/instruction_errors_limits/soft/max", "SM2001"},
  };
}

}  // namespace fieldproof::xnet_broken
