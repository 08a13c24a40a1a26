// Counts by verdict, and what they mean for the gate.
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "reports/results/case_result.hpp"
#include "reports/results/verdict.hpp"

namespace fieldproof::text {

class Tally {
 public:
  /// In the order of the design's table.
  static constexpr std::array<results::Verdict, 11> verdicts = {
      results::Verdict::pass,         results::Verdict::marginal, results::Verdict::non_strict,
      results::Verdict::info,         results::Verdict::fail,     results::Verdict::xfail,
      results::Verdict::xpass,        results::Verdict::skip,     results::Verdict::blocked,
      results::Verdict::inconclusive, results::Verdict::error};

  void add(results::Verdict verdict, std::size_t count = 1) {
    counts_[static_cast<std::size_t>(verdict)] += count;
  }
  /// A result; of a model where it says so.
  void add(const results::CaseResult& result) {
    add(result.verdict);
    if (!result.on_model.empty() && result.verdict != results::Verdict::skip)
      ++on_model_[result.on_model];
  }
  void add(const Tally& other) {
    for (results::Verdict verdict : verdicts) add(verdict, other.of(verdict));
  }
  std::size_t of(results::Verdict verdict) const {
    return counts_[static_cast<std::size_t>(verdict)];
  }
  std::size_t total() const;
  /// Those with a verdict on the device.
  std::size_t judged() const;
  /// Those that could have one: all but SKIP.
  std::size_t applicable() const { return total() - of(results::Verdict::skip); }
  /// How many were of a model, by kind: no wire conformance.
  const std::map<std::string, std::size_t>& on_model() const { return on_model_; }
  /// How many results turn the gate red.
  std::size_t gating(const results::Gate& gate) const;
  bool operator==(const Tally&) const = default;

 private:
  std::array<std::size_t, verdicts.size()> counts_{};
  std::map<std::string, std::size_t> on_model_;
};

/// "on a model, not on a wire: 1,234 (404 instruction, 830 register)"; empty where none is.
std::string on_model_text(const Tally& tally);

/// "1402 PASS, 2 FAIL": those that occur; "nothing" when none does.
std::string to_string(const Tally& tally);

/// How a verdict stands in JUnit: `failure` follows the gate. What was not judged stays `skipped`
/// whatever the gate says, because a reader of the report would look for a frame that never was;
/// that the gate is red stands in a test case of its own.
enum class JunitOutcome { plain, failure, error, skipped };
JunitOutcome junit_outcome(results::Verdict verdict, const results::Gate& gate);

/// "1,824 of 2,948 judged": of those that the device could be judged by.
std::string judged_text(const Tally& tally);

/// In percent.
double share_judged(const Tally& tally);
/// A green gate of a run that left most of its cases out says so.
bool is_less_than_half(const Tally& tally);

/// "1,824".
std::string grouped(std::size_t number);

/// Why these results do not meet the gate; nothing where they do. An ERROR is bench trouble (3),
/// whatever fails the gate is 1, as is less judged than it asks for, and nothing judged at all (no
/// result, or only SKIP, BLOCKED and INCONCLUSIVE) is 4.
std::vector<results::Reason> reasons_of(const Tally& tally, const results::Gate& gate);

/// "gate not met", for any exit code of the tool.
std::string exit_meaning(int exit_code);

/// The gate as a property of a run, so that a report made later from the results judges alike:
/// "strict, qualify, min-judged 90%"; "default" when no option is set.
std::string to_string(const results::Gate& gate);
/// The reverse; what it does not know counts as not set.
results::Gate parse_gate(const std::string& text);
/// That a run was judged by.
results::Gate gate_of(const results::RunInfo& run);

}  // namespace fieldproof::text
