#include "reports/results/verdict.hpp"

#include <array>
#include <cstddef>

namespace fieldproof::results {
namespace {

// In the order of the enumeration.
constexpr std::array<std::string_view, 11> words = {"PASS",    "MARGINAL",     "NON-STRICT", "INFO",
                                                    "FAIL",    "XFAIL",        "XPASS",      "SKIP",
                                                    "BLOCKED", "INCONCLUSIVE", "ERROR"};
static_assert(words.size() == static_cast<std::size_t>(Verdict::error) + 1);

}  // namespace

std::string_view to_string(Verdict verdict) { return words.at(static_cast<std::size_t>(verdict)); }

std::optional<Verdict> parse_verdict(std::string_view text) {
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i] == text) return static_cast<Verdict>(i);
  }
  return std::nullopt;
}

bool is_judged(Verdict verdict) {
  return verdict != Verdict::skip && verdict != Verdict::blocked &&
         verdict != Verdict::inconclusive && verdict != Verdict::error;
}

bool gates(Verdict verdict, const Gate& gate) {
  switch (verdict) {
    case Verdict::fail:
    case Verdict::xpass:
    case Verdict::error: return true;
    case Verdict::non_strict: return gate.strict;
    case Verdict::marginal: return gate.fail_on_marginal;
    case Verdict::blocked:
    case Verdict::inconclusive: return gate.qualify;
    case Verdict::pass:
    case Verdict::info:
    case Verdict::xfail:
    case Verdict::skip: return false;
  }
  return true;  // nothing passes by default
}

}  // namespace fieldproof::results
