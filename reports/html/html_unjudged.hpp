// What was not judged: what would let it be judged, and what is none of the device's.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "reports/html/html_survey.hpp"

namespace fieldproof::html {

/// Reasons that one thing would end.
struct UnjudgedGroup {
  std::string what;  // of BLOCKED the remedy, else the reason
  std::size_t cases = 0;
  std::vector<std::pair<std::string, const Unexecuted*>> reasons;  // most cases first
};
/// Of a verdict, the greatest first.
std::vector<UnjudgedGroup> unjudged_groups(const HtmlSurvey& survey, results::Verdict verdict);

/// A heading a verdict: BLOCKED by what would unblock, INCONCLUSIVE and SKIP by reason; each opens
/// to its reasons and cases.
void write_unjudged(HtmlWriter& out, const HtmlSurvey& survey);

/// The same for paper, a line a group: those of SKIP, which is about other models, together.
void write_unjudged_lines(HtmlWriter& out, const HtmlSurvey& survey);

}  // namespace fieldproof::html
