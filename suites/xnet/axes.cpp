#include "suites/xnet/axes.hpp"

#include <algorithm>
#include <array>
#include <charconv>

#include "src/xnet/words.hpp"
#include "src/xnet_motion/axis_registers.hpp"
#include "suites/xnet/instruction_text.hpp"

namespace fieldproof::xnet_suite {

std::string axis_of_action(std::string_view action) {
  constexpr std::array<std::string_view, 9> moving{"MOTO",  "MOTOA",  "MOTOS",   "MOSTOP", "MOGOON",
                                                   "MOSYN", "MOUSYN", "MOWRITE", "MOREAD"};
  const std::string of = take_plc(action);
  xnet::Words words(without_hold(action));
  const std::string_view name = words.next();
  if (std::ranges::count(moving, name) == 0) return {};
  const std::string_view key = name == "MOSYN" ? "slave" : "axis";
  for (std::string_view word = words.next(); !word.empty(); word = words.next())
    if (word == key) return of + std::string(words.next());
  return of + "?";
}

std::vector<harness::Protocol::Setting> at_rest(std::string_view axis) {
  const std::string of = take_plc(axis);
  std::uint32_t number = 1;
  std::from_chars(axis.data(), axis.data() + axis.size(), number);
  const auto place = [&](const xnet::Register& one) {
    const std::uint32_t further =
        xnet::stride_of(one.area) * (std::clamp(number, 1u, xnet::last_axis) - 1);
    return of + to_string(xnet::component_in(one.area, one.first + further));
  };
  return {{place(xnet::reg::position), "00000000"},
          {place(xnet::reg::error), "00000000"},
          {place(xnet::reg::enabled), "00"}};
}

}  // namespace fieldproof::xnet_suite
