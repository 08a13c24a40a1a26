#include "harness/judge/readings.hpp"

#include <fmt/format.h>

namespace fieldproof::judging {

void Readings::note(results::CaseResult& result) {
  for (const auto& [name, choice] : result.readings) {
    const auto [first, is_new] = first_.try_emplace(name, choice, result.id);
    if (is_new || first->second.first == choice ||
        (result.verdict != results::Verdict::pass &&
         result.verdict != results::Verdict::non_strict))
      continue;
    result.verdict = results::Verdict::non_strict;
    result.message = fmt::format("mixes readings: {} = {} here, {} in {}", name, choice,
                                 first->second.first, first->second.second);
  }
}

}  // namespace fieldproof::judging
