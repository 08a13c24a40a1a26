#include "harness/judge/findings.hpp"

#include <fmt/format.h>

namespace fieldproof::judging {

using results::Verdict;

void Findings::miss(std::string message) {
  if (missed_) return;
  missed_ = true;
  result.verdict = Verdict::fail;
  result.message = std::move(message);
}

void Findings::lower_to(Verdict verdict, std::string message) {
  if (missed_ || (result.verdict != Verdict::pass && verdict == Verdict::marginal)) return;
  result.verdict = verdict;
  result.message = std::move(message);
}

void Findings::miss_or_lower(bool binding, std::string message) {
  if (binding) return miss(std::move(message));
  lower_to(Verdict::non_strict, std::move(message));
}

void Findings::block(std::string message) {
  if (missed_) return;
  result.verdict = Verdict::blocked;
  result.message = std::move(message);
  missed_ = true;
}

void Findings::miss_in_any_case(std::string message) {
  if (result.verdict == Verdict::blocked) {
    missed_ = false;
    message += "; " + result.message;
  }
  if (missed_)
    result.notes.push_back(std::move(message));
  else
    miss(std::move(message));
}

void Findings::settle(const vectors::Case& source, const vectors::Binding& decisions) {
  if (result.verdict == Verdict::blocked) return;
  if (missed_ && vectors::rests_on_decisions(source)) {
    for (const vectors::Decision& one : source.decisions)
      result.notes.push_back(
          fmt::format("decision {}{}{}", one.id, one.sentence.empty() ? "" : ": ", one.sentence));
    if (!decisions.holds_all(source.decisions)) {
      result.verdict = Verdict::non_strict;
      result.notes.push_back("the manuals are silent here; this project decided: " + source.why);
    }
  }
  if (missed_ && source.level == "should") result.verdict = Verdict::non_strict;
  if (source.level == "info" && result.verdict != Verdict::error) {
    result.message = missed_ ? "measured, no requirement: " + result.message
                             : "measured, no requirement: as written";
    result.verdict = Verdict::info;
  }
}

}  // namespace fieldproof::judging
