// What may stand before an instruction in the text of an action: "B: hold REG_READ ...".
#pragma once

#include <algorithm>
#include <string>
#include <string_view>

namespace fieldproof::xnet_suite {

/// Takes "B:" and blanks behind it off the text; empty: it is of the PLC itself.
inline std::string take_plc(std::string_view& action) {
  const bool named = action.size() > 2 && action[1] == ':';
  const std::string of(named ? action.substr(0, 2) : "");
  action.remove_prefix(of.size());
  action.remove_prefix(std::min(action.find_first_not_of(' '), action.size()));
  return of;
}

constexpr std::string_view hold = "hold ";
/// Its condition stays on.
inline std::string_view without_hold(std::string_view text) {
  return text.starts_with(hold) ? text.substr(hold.size()) : text;
}

}  // namespace fieldproof::xnet_suite
