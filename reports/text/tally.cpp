#include "reports/text/tally.hpp"

#include <fmt/format.h>

#include <numeric>

namespace fieldproof::text {

using results::Gate;
using results::Verdict;

std::size_t Tally::total() const {
  return std::accumulate(counts_.begin(), counts_.end(), std::size_t{0});
}

std::size_t Tally::gating(const Gate& gate) const {
  std::size_t count = 0;
  for (Verdict verdict : verdicts) count += results::gates(verdict, gate) ? of(verdict) : 0;
  return count;
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

int gate_exit_code(const Tally& tally, const Gate& gate, bool interrupted) {
  if (interrupted) return 130;
  if (tally.of(Verdict::error) > 0) return 3;
  if (tally.gating(gate) > 0) return 1;
  if (tally.total() ==
      tally.of(Verdict::skip) + tally.of(Verdict::blocked) + tally.of(Verdict::inconclusive))
    return 4;
  return 0;
}

std::string exit_meaning(int exit_code) {
  switch (exit_code) {
    case 0: return "gate met";
    case 1: return "conformance failed";
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
  const auto add = [&](bool set, const char* word) {
    if (set) text += fmt::format("{}{}", text.empty() ? "" : ", ", word);
  };
  add(gate.strict, "strict");
  add(gate.fail_on_marginal, "fail-on marginal");
  add(gate.qualify, "qualify");
  return text.empty() ? "default" : text;
}

Gate parse_gate(const std::string& text) {
  const auto has = [&](const char* word) {
    return (", " + text + ",").find(fmt::format(", {},", word)) != std::string::npos;
  };
  return {.strict = has("strict"),
          .fail_on_marginal = has("fail-on marginal"),
          .qualify = has("qualify")};
}

Gate gate_of(const results::RunInfo& run) {
  const auto gate = run.properties.find("gate");
  return gate == run.properties.end() ? Gate{} : parse_gate(gate->second);
}

}  // namespace fieldproof::text
