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
  take_plc(action);
  xnet::Words words(without_hold(action));
  const std::string_view name = words.next();
  if (std::ranges::count(moving, name) == 0) return {};
  const std::string_view key = name == "MOSYN" ? "slave" : "axis";
  for (std::string_view word = words.next(); !word.empty(); word = words.next())
    if (word == key) return std::string(words.next());
  return "?";
}

std::string axis_of(const xnet::Component& object) {
  std::uint32_t begin = ~0u;  // of the block of axis 1
  for (const xnet::Register& one : xnet::axis_registers())
    if (one.area == object.area->name) begin = std::min(begin, one.first);
  const std::uint32_t stride = xnet::stride_of(object.area->name);
  const bool inside = object.number >= begin && object.number - begin < xnet::last_axis * stride;
  return inside ? std::to_string((object.number - begin) / stride + 1) : "";
}

std::vector<harness::Protocol::Setting> at_rest(std::string_view axis) {
  std::uint32_t number = 1;
  std::from_chars(axis.data(), axis.data() + axis.size(), number);
  const auto place = [&](const xnet::Register& one) {
    const std::uint32_t further =
        xnet::stride_of(one.area) * (std::clamp(number, 1u, xnet::last_axis) - 1);
    return to_string(xnet::component_in(one.area, one.first + further));
  };
  return {{place(xnet::reg::position), "00000000"},
          {place(xnet::reg::error), "00000000"},
          {place(xnet::reg::enabled), "00"}};
}

}  // namespace fieldproof::xnet_suite
