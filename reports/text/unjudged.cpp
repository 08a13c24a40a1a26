#include "reports/text/unjudged.hpp"

#include <algorithm>
#include <array>

#include "reports/text/failures.hpp"
#include "reports/text/remedy.hpp"

namespace fieldproof::text {

using results::CaseResult;
using results::Verdict;

namespace {

constexpr std::size_t most_reasons = 1000;  // what is of a further one counts as such alone
constexpr std::array order = {Verdict::blocked, Verdict::inconclusive, Verdict::skip};

/// Which models a case is for instead matters to nobody at the bench.
std::string reason_of(const CaseResult& result) {
  const std::string& message = result.message;
  if (message.empty()) return "no reason given";
  if (result.verdict == Verdict::blocked) return remedy_of(message);
  const std::size_t declares = message.find("; the profile declares ");
  const bool of_models = result.verdict == Verdict::skip && message.starts_with("for ");
  return of_models && declares != std::string::npos ? "for other models" + message.substr(declares)
                                                    : message;
}

auto rank(const UnjudgedReason& one) {
  return std::pair(std::ranges::find(order, one.verdict) - order.begin(),
                   -static_cast<std::ptrdiff_t>(one.cases));
}

}  // namespace

void Unjudged::add(const CaseResult& result) {
  std::string text = reason_of(result);
  std::pair key(result.verdict, kind_of(text));
  if (known_.size() >= most_reasons && !known_.contains(key)) key.second = text = "further reasons";
  UnjudgedReason& one = known_[key];
  one.verdict = result.verdict;
  if (one.cases++ == 0) one.text = std::move(text);
}

std::vector<UnjudgedReason> Unjudged::reasons() const {
  std::vector<UnjudgedReason> all;
  for (const auto& [key, one] : known_) all.push_back(one);
  std::ranges::stable_sort(all, {}, rank);
  return all;
}

}  // namespace fieldproof::text
