#include "suites/xnet/axes.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <set>

#include "src/xnet/words.hpp"
#include "src/xnet_motion/axis_registers.hpp"
#include "suites/modbus/xinje_objects.hpp"
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

namespace {

using harness::Protocol;

/// A value of an axis: "B:" and number, and which of its registers.
struct AxisValue {
  std::string axis;
  std::string_view area;
  std::uint32_t first = 0;  // as of axis 1

  bool is(const xnet::Register& one) const { return area == one.area && first == one.first; }
};

std::optional<AxisValue> axis_value(std::string_view address, xnet::Series series) {
  const std::string of = take_plc(address);
  const std::optional<xnet::Component> one = xnet::find_component(address, series);
  const std::string number = one ? modbus_suite::xinje_axis(*one) : "";
  if (number.empty()) return std::nullopt;
  const auto further =
      static_cast<std::uint32_t>(xnet::stride_of(one->area->name)) * (std::stoul(number) - 1);
  return AxisValue{of + number, one->area->name, static_cast<std::uint32_t>(one->number - further)};
}

bool is_zero(std::string_view digits) {
  return !digits.empty() && digits.find_first_not_of('0') == std::string_view::npos;
}

/// What one look says of the axes.
struct Seen {
  bool any = false;                // of an axis
  std::set<std::string> standing;  // their moving flag is off
  bool moving = false;             // one is under way
};

Seen seen_in(const Protocol::Look& look, xnet::Series series) {
  Seen seen;
  std::set<std::string> passing;  // axes with a range, or a speed
  for (const auto& [address, digits] : look) {
    const std::optional<AxisValue> value = axis_value(address, series);
    if (!value) continue;
    seen.any = true;
    const bool speed = value->is(xnet::reg::speed) || value->is(xnet::reg::set_speed);
    if (value->is(xnet::reg::running) && is_zero(digits))
      seen.standing.insert(value->axis);
    else if (value->is(xnet::reg::running))
      seen.moving = true;
    else if (digits.empty() || (speed && !is_zero(digits)))
      passing.insert(value->axis);
  }
  for (const std::string& axis : passing) seen.moving |= !seen.standing.contains(axis);
  return seen;
}

/// Has it a value of an axis that another look has otherwise?
bool differs(const Protocol::Look& look, const Protocol::Look& later, xnet::Series series) {
  for (const auto& [address, digits] : look)
    for (const auto& [other, then] : later)
      if (address == other && digits != then && axis_value(address, series)) return true;
  return false;
}

}  // namespace

std::vector<bool> looks_under_way(const std::vector<Protocol::Look>& looks, xnet::Series series) {
  std::vector<bool> passing(looks.size());
  std::vector<Seen> seen;
  for (std::size_t i = 0; i < looks.size(); ++i) {
    seen.push_back(seen_in(looks[i], series));
    passing[i] = seen[i].moving;
    for (std::size_t later = i + 1; later < looks.size(); ++later)
      passing[i] = passing[i] || differs(looks[i], looks[later], series);
  }
  if (std::ranges::count(passing, true) == 0) return passing;
  for (std::size_t i = 0; i + 1 < looks.size(); ++i)
    passing[i] = passing[i] || (seen[i].any && seen[i].standing.empty());
  return passing;
}

}  // namespace fieldproof::xnet_suite
