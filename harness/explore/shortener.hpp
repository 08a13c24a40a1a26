// A sequence that shows something wrong, made as short as it still shows that.
#pragma once

#include <functional>
#include <utility>

#include "harness/explore/sequence.hpp"
#include "reports/results/case_result.hpp"

namespace fieldproof::explore {

class Shortener {
 public:
  using Run = std::function<results::CaseResult(const Sequence&)>;

  /// `alive`: further sequences can run. `verdict`: what was shown.
  Shortener(Run run, std::function<bool()> alive, results::Verdict verdict)
      : run_(std::move(run)), alive_(std::move(alive)), verdict_(verdict) {}

  /// Up to what failed; then without what it still shows without: halves, quarters, single parts,
  /// and the same of its settings.
  Sequence::Own shortest(Sequence::Own sequence, std::size_t failing);
  /// Is something wrong with it that is as grave? What is shown as graver once is so from then on:
  /// a needless refusal may have been all that made a failure a matter of decisions.
  bool shows(const Sequence& sequence);

 private:
  bool goes_on() const;
  template <typename Count, typename Without>
  Sequence::Own less(Sequence::Own sequence, std::size_t least, Count count, Without without);

  Run run_;
  std::function<bool()> alive_;
  results::Verdict verdict_;  // the gravest that was shown
  int trials_ = 0;
  int losses_ = 0;  // of the device, which had to be started again
};

/// Is it red for what the device did?
bool differs(results::Verdict verdict);

}  // namespace fieldproof::explore
