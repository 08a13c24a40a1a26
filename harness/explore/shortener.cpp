#include "harness/explore/shortener.hpp"

#include <algorithm>

namespace fieldproof::explore {

using results::CaseResult;
using results::Verdict;

namespace {

constexpr int most_trials = 200;
// Each takes seconds, and a start of those that the run has.
constexpr int most_losses = 3;

bool lost_the_device(const CaseResult& result) {
  return result.verdict == Verdict::error ||
         std::ranges::find(result.notes, "power-cycled the device") != result.notes.end();
}

}  // namespace

bool differs(Verdict verdict) { return verdict == Verdict::fail || verdict == Verdict::non_strict; }

bool Shortener::goes_on() const {
  return trials_ < most_trials && losses_ < most_losses && alive_();
}

bool Shortener::shows(const Sequence& sequence) {
  const CaseResult result = run_(sequence);
  ++trials_;
  losses_ += lost_the_device(result);
  if (result.verdict == Verdict::fail) verdict_ = Verdict::fail;
  return differs(result.verdict) && result.verdict == verdict_;
}

template <typename Count, typename Without>
Sequence::Own Shortener::less(Sequence::Own sequence, std::size_t least, Count count,
                              Without without) {
  const std::size_t half = (count(*sequence) + 1) / 2;
  for (std::size_t size = half; size > 0; size /= 2)
    for (std::size_t at = 0; at < count(*sequence) && goes_on();) {
      if (count(*sequence) < size + least) break;
      Sequence::Own shorter = without(*sequence, at, size);
      if (shorter && shows(*shorter))
        sequence = std::move(shorter);
      else
        at += size;
    }
  return sequence;
}

Sequence::Own Shortener::shortest(Sequence::Own sequence, std::size_t failing) {
  if (failing + 1 < sequence->parts())
    if (Sequence::Own begun = sequence->without(failing + 1, sequence->parts() - failing - 1);
        begun && shows(*begun))
      sequence = std::move(begun);
  sequence = less(
      std::move(sequence), 1, [](const Sequence& one) { return one.parts(); },
      [](const Sequence& one, std::size_t at, std::size_t count) {
        return one.without(at, count);
      });
  trials_ = 0;
  return less(
      std::move(sequence), 0, [](const Sequence& one) { return one.settings(); },
      [](const Sequence& one, std::size_t at, std::size_t count) {
        return one.without_settings(at, count);
      });
}

}  // namespace fieldproof::explore
