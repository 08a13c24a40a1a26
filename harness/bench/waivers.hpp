// Known failures that the team accepts for a while: id, reason and expiry date.
#pragma once

#include <string>
#include <vector>

#include "harness/results/case_result.hpp"
#include "src/base/result.hpp"

namespace fieldproof {

struct Waiver {
  std::string id;       // of a case, or a glob
  std::string reason, owner;
  std::string expires;  // ISO date, the last day on which it holds
  std::string text;     // must be part of the failure's message; empty: any failure
};

/// Reads [{"id","reason","expires","owner"?,"text"?}]. Errors name file and entry.
Result<std::vector<Waiver>> parse_waivers(const std::string& text, const std::string& file);
Result<std::vector<Waiver>> load_waivers(const std::string& path);

/// Waivers that select none of `ids`: an unknown target is an error.
std::vector<std::string> unmatched(const std::vector<Waiver>& waivers, const std::vector<std::string>& ids);

/// FAIL becomes XFAIL while a waiver holds; PASS becomes XPASS, and a waiver that is expired or whose text no longer
/// matches leaves the failure as it is and says so. `today` is an ISO date.
void apply_waivers(const std::vector<Waiver>& waivers, const std::string& today, CaseResult& result);

}  // namespace fieldproof
