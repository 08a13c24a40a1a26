#include "harness/explore/explorer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "harness/vectors/fingerprint.hpp"
#include "harness/vectors/loader.hpp"

namespace fieldproof::explore {

using results::CaseResult;
using results::Verdict;

namespace {

constexpr std::size_t most_findings = 50;  // more are counted
constexpr int most_trials = 200;           // of shortening one finding
constexpr int confirmations = 3;

bool differs(Verdict verdict) { return verdict == Verdict::fail || verdict == Verdict::non_strict; }

Byte upper(Byte byte) { return static_cast<Byte>(std::toupper(byte)); }

/// The same fault shows in many sequences: by what was asked, and what was wrong, without numbers.
std::string mark_of(const Topic& topic, const CaseResult& result) {
  std::string words;
  for (const char c : result.message)
    if (!std::isdigit(static_cast<unsigned char>(c)) &&
        !std::isupper(static_cast<unsigned char>(c)))
      words += c;
  return fmt::format("{}/{}: {}", topic.name, topic.kind, words);
}

/// The same answer in other letters: which ones a device writes is open in many places, and vectors
/// ask where it is not.
bool differs_in_letters_alone(const CaseResult& result) {
  return !result.received_bytes.empty() &&
         std::ranges::equal(result.expected_bytes, result.received_bytes, {}, upper, upper);
}

}  // namespace

CaseResult Explorer::run(const Sequence& sequence, const std::string& id) {
  vectors::Case& one = running_[turn_ ^= 1];
  one = sequence.as_case(id);
  sent_ += sequence.requests();
  return device_.run(one);
}

void Explorer::step() {
  Sequence::Own sequence = inventor_->invent();
  barren_ = sequence ? 0 : barren_ + 1;
  if (!sequence) return;
  ++sequences_;
  const CaseResult result = run(*sequence, fmt::format("explore/{}", sequences_));
  note(std::move(sequence), result);
}

void Explorer::note(Sequence::Own sequence, const CaseResult& result) {
  if (differs(result.verdict) && differs_in_letters_alone(result)) {
    ++unjudged_[{Verdict::blocked, "the same answers, in other letters"}];
    return;
  }
  const bool as_the_model = result.verdict == Verdict::pass || result.verdict == Verdict::marginal;
  if (!differs(result.verdict) && !as_the_model) {
    ++unjudged_[{result.verdict, result.message}];
    return;
  }
  ++judged_;
  if (!as_the_model) return note_finding(std::move(sequence), result);
  for (std::size_t i = 0; i < sequence->parts(); ++i) {
    const Topic topic = sequence->topic(i);
    inventor_->note(topic, ++seen_[{topic.name, topic.kind}][sequence->outcome(i)]);
  }
}

bool Explorer::shows(const Sequence& sequence, Verdict verdict) {
  return run(sequence, "explore/shorter").verdict == verdict;
}

/// Up to what failed; then leaves out what it still shows without: halves, quarters, single parts.
Sequence::Own Explorer::shortest(Sequence::Own sequence, std::size_t failing, Verdict verdict) {
  if (failing + 1 < sequence->parts())
    if (Sequence::Own begun = sequence->without(failing + 1, sequence->parts() - failing - 1);
        begun && shows(*begun, verdict))
      sequence = std::move(begun);
  int trials = 0;
  for (std::size_t size = std::max<std::size_t>(1, sequence->parts() / 2); size > 0; size /= 2)
    for (std::size_t at = 0; at < sequence->parts() && trials < most_trials && device_.alive();) {
      if (sequence->parts() <= size) break;
      Sequence::Own shorter = sequence->without(at, size);
      ++trials;
      if (shorter && shows(*shorter, verdict))
        sequence = std::move(shorter);
      else
        at += size;
    }
  return without_needless_settings(std::move(sequence), verdict);
}

Sequence::Own Explorer::without_needless_settings(Sequence::Own sequence, Verdict verdict) {
  for (std::size_t at = 0; at < sequence->settings() && device_.alive();) {
    Sequence::Own lean = sequence->without_setting(at);
    if (lean && shows(*lean, verdict))
      sequence = std::move(lean);
    else
      ++at;
  }
  return sequence;
}

void Explorer::note_finding(Sequence::Own sequence, const CaseResult& result) {
  const std::size_t failing = sequence->failing_part(result);
  const std::string mark = mark_of(sequence->topic(failing), result);
  if (const auto known = findings_.find(mark); known != findings_.end()) {
    ++known->second.times;
    return;
  }
  if (findings_.size() >= most_findings) {
    ++unjudged_[{result.verdict, "differs, not looked into: there are 50 findings"}];
    return;
  }
  const std::string id = fmt::format(
      "{}/explore/f{:08x}", vectors::folder_of(*device_.protocol),
      static_cast<std::uint32_t>(vectors::extend_fingerprint(vectors::empty_fingerprint, mark)));
  Finding finding;
  finding.shortest = sequence->as_case(id);
  const Sequence::Own found = shortest(std::move(sequence), failing, result.verdict);
  int shown = 0;
  while (shown < confirmations && device_.alive() && shows(*found, result.verdict)) ++shown;
  finding.confirmed = shown == confirmations;
  if (finding.confirmed) finding.shortest = found->as_case(id);
  finding.result = finding.confirmed ? device_.run(finding.shortest) : result;
  finding.result.id = id;
  findings_.emplace(mark, std::move(finding));
}

}  // namespace fieldproof::explore
