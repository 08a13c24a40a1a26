#include "reports/results/reason.hpp"

#include <algorithm>
#include <array>

namespace fieldproof::results {
namespace {

constexpr std::array by_precedence = {130, 3, 1, 4};

}  // namespace

bool is_shown_by_cases(const Reason& reason) { return reason.what == "verdicts"; }

int exit_code_of(const std::vector<Reason>& reasons) {
  for (const int code : by_precedence)
    if (std::ranges::find(reasons, code, &Reason::exit_code) != reasons.end()) return code;
  return 0;
}

std::string to_string(const std::vector<Reason>& reasons) {
  std::string text;
  for (const int code : by_precedence)
    for (const Reason& reason : reasons)
      if (reason.exit_code == code) text += (text.empty() ? "" : "; ") + reason.message;
  return text;
}

}  // namespace fieldproof::results
