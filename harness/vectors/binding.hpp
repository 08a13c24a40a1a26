// Which decisions a device is held to: those that its profile names, all, or none.
#pragma once

#include <algorithm>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "harness/vectors/case.hpp"

namespace fieldproof::vectors {

/// What response_max of a profile rests on where no manual prints a time.
inline constexpr std::string_view reply_time_decision = "server/reply-time";

/// What follows from the manuals only together with a decision of ours does not bind without it; a
/// printed vector names decisions for its alternatives alone.
inline bool rests_on_decisions(const Case& one) {
  return one.basis == "decision" || (one.basis == "derived" && !one.decisions.empty());
}

struct Binding {
  bool all = true;                           // "decisions": "binding"; "advisory": false
  std::set<std::string, std::less<>> named;  // "decisions": ["server/reply-time"]: these alone

  bool holds(std::string_view id) const { return all || named.contains(id); }
  /// What rests on several decisions binds where each of them does, on none that is named never.
  bool holds_all(const std::vector<Decision>& decisions) const {
    return all || (!decisions.empty() &&
                   std::ranges::all_of(decisions, [&](const auto& one) { return holds(one.id); }));
  }
};

}  // namespace fieldproof::vectors
