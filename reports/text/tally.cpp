#include "reports/text/tally.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <numeric>
#include <string_view>

namespace fieldproof::text {

using results::Gate;
using results::Reason;
using results::Verdict;

namespace {

constexpr std::string_view min_judged_word = "min-judged ";

}  // namespace

std::size_t Tally::total() const {
  return std::accumulate(counts_.begin(), counts_.end(), std::size_t{0});
}

std::size_t Tally::judged() const {
  std::size_t count = 0;
  for (Verdict verdict : verdicts) count += results::is_judged(verdict) ? of(verdict) : 0;
  return count;
}

std::size_t Tally::gating(const Gate& gate) const {
  std::size_t count = 0;
  for (Verdict verdict : verdicts) count += results::gates(verdict, gate) ? of(verdict) : 0;
  return count;
}

std::string on_model_text(const Tally& tally) {
  std::size_t all = 0;
  std::string kinds;
  for (const auto& [kind, count] : tally.on_model()) {
    all += count;
    kinds += fmt::format("{}{} {}", kinds.empty() ? "" : ", ", grouped(count), kind);
  }
  if (all == 0) return "";
  return fmt::format("on a model, not on a wire: {} ({})", grouped(all), kinds);
}

std::string to_string(const Tally& tally) {
  std::string text;
  for (Verdict verdict : Tally::verdicts) {
    if (tally.of(verdict) == 0) continue;
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", tally.of(verdict),
                        results::to_string(verdict));
  }
  return text.empty() ? "nothing" : text;
}

JunitOutcome junit_outcome(Verdict verdict, const Gate& gate) {
  switch (verdict) {
    case Verdict::error: return JunitOutcome::error;
    case Verdict::xfail:
    case Verdict::skip:
    case Verdict::blocked:
    case Verdict::inconclusive: return JunitOutcome::skipped;
    default: return results::gates(verdict, gate) ? JunitOutcome::failure : JunitOutcome::plain;
  }
}

std::string grouped(std::size_t number) {
  std::string text = std::to_string(number);
  for (std::size_t at = text.size(); at > 3;) text.insert(at -= 3, ",");
  return text;
}

std::string judged_text(const Tally& tally) {
  return fmt::format("{} of {} judged", grouped(tally.judged()), grouped(tally.applicable()));
}

double share_judged(const Tally& tally) {
  return static_cast<double>(tally.judged()) * 100 / static_cast<double>(tally.applicable());
}

bool is_less_than_half(const Tally& tally) { return 2 * tally.judged() < tally.applicable(); }

std::vector<Reason> reasons_of(const Tally& tally, const Gate& gate) {
  std::vector<Reason> reasons;
  const std::size_t errors = tally.of(Verdict::error), judged = tally.judged();
  const std::size_t unjudged = tally.of(Verdict::blocked) + tally.of(Verdict::inconclusive);
  if (errors > 0)
    reasons.push_back({3, "verdicts", fmt::format("bench trouble: {} ERROR", errors)});
  Tally failed;
  for (Verdict verdict : Tally::verdicts)
    if (results::is_judged(verdict) && results::gates(verdict, gate))
      failed.add(verdict, tally.of(verdict));
  if (failed.total() > 0)
    reasons.push_back({1, "verdicts", "conformance failed: " + to_string(failed)});
  if (gate.qualify && unjudged > 0)
    reasons.push_back(
        {1, "qualify", fmt::format("not qualified: {} not judged", grouped(unjudged))});
  if (judged + errors == 0)
    reasons.push_back({4, "nothing", "nothing selected or executed"});
  else if (share_judged(tally) < gate.min_judged)
    reasons.push_back({1, "min-judged",
                       fmt::format("too little judged: {} ({:.1f}%), --min-judged asks for {:g}%",
                                   judged_text(tally), share_judged(tally), gate.min_judged)});
  return reasons;
}

std::string exit_meaning(int exit_code) {
  switch (exit_code) {
    case 0: return "gate met";
    case 1: return "gate not met";
    case 2: return "usage, or an invalid vector, profile or bench file";
    case 3: return "bench trouble";
    case 4: return "nothing selected or executed";
    case 77: return "hardware absent";
    case 130: return "interrupted";
    default: return "unknown";
  }
}

std::string to_string(const Gate& gate) {
  std::string text;
  const auto add = [&](bool set, const std::string& word) {
    if (set) text += fmt::format("{}{}", text.empty() ? "" : ", ", word);
  };
  add(gate.strict, "strict");
  add(gate.fail_on_marginal, "fail-on marginal");
  add(gate.qualify, "qualify");
  if (gate.min_judged > 0) add(true, fmt::format("{}{:g}%", min_judged_word, gate.min_judged));
  return text.empty() ? "default" : text;
}

Gate parse_gate(const std::string& text) {
  const auto has = [&](const char* word) {
    return (", " + text + ",").find(fmt::format(", {},", word)) != std::string::npos;
  };
  Gate gate{.strict = has("strict"),
            .fail_on_marginal = has("fail-on marginal"),
            .qualify = has("qualify")};
  if (const std::size_t at = text.find(min_judged_word); at != std::string::npos)
    gate.min_judged = std::atof(text.c_str() + at + min_judged_word.size());
  return gate;
}

Gate gate_of(const results::RunInfo& run) {
  const auto gate = run.properties.find("gate");
  return gate == run.properties.end() ? Gate{} : parse_gate(gate->second);
}

}  // namespace fieldproof::text
