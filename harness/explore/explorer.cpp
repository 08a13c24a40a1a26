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
constexpr int confirmations = 3;
constexpr int most_looks = 4;  // at sequences that may show a finding to be graver

Byte upper(Byte byte) { return static_cast<Byte>(std::toupper(byte)); }

/// The same answer in other letters: which ones a device writes is open in many places, and vectors
/// ask where it is not.
bool differs_in_letters_alone(const CaseResult& result) {
  return !result.received_bytes.empty() &&
         std::ranges::equal(result.expected_bytes, result.received_bytes, {}, upper, upper);
}

std::uint64_t silences_in(const Sequence& sequence) {
  std::uint64_t silences = 0;
  for (std::size_t part = 0; part < sequence.parts(); ++part)
    silences += sequence.outcome(part) == "silence";
  return silences;
}

std::string in_words(const Topic& topic) { return topic.name + "/" + topic.kind; }

std::string id_of(const harness::Protocol& protocol, const std::string& mark) {
  return fmt::format(
      "{}/explore/f{:08x}", vectors::folder_of(protocol),
      static_cast<std::uint32_t>(vectors::extend_fingerprint(vectors::empty_fingerprint, mark)));
}

}  // namespace

CaseResult Explorer::run(const Sequence& sequence, const std::string& id) {
  vectors::Case& one = running_[turn_ ^= 1];
  one = sequence.as_case(id);
  CaseResult result = device_.run(one);
  if (result.verdict != Verdict::blocked && result.verdict != Verdict::skip)
    sent_ += sequence.requests();
  if (result.verdict != Verdict::blocked) barren_ = 0;
  return result;
}

/// Where time is real, nearly all of it would be spent on waiting: silences are seen about as often
/// with many answers between them as one behind the other.
bool Explorer::waits_too_long(std::uint64_t silences) const {
  return device_.real_time && silences > 0 &&
         (silences_ + silences - 1) * requests_for_a_silence > sent_;
}

void Explorer::step() {
  Sequence::Own sequence = inventor_->invent();
  const std::uint64_t silences = sequence ? silences_in(*sequence) : 0;
  if (!sequence || waits_too_long(silences)) {
    ++barren_;
    return;
  }
  silences_ += silences;
  ++sequences_;
  const CaseResult result = run(*sequence, fmt::format("explore/{}", sequences_));
  note(std::move(sequence), result);
}

void Explorer::note(Sequence::Own sequence, const CaseResult& result) {
  if (result.verdict == Verdict::pass || result.verdict == Verdict::marginal)
    return note_as_expected(*sequence);
  if (!differs(result.verdict)) return note_unjudged(*sequence, result);
  if (differs_in_letters_alone(result))
    return count_unjudged(Verdict::blocked, "the same answers, in other letters", result);
  const std::size_t failing = sequence->failing_part(result);
  if (inventor_->may_learn(*sequence, failing)) {
    if (!learnt(*sequence, failing, result))
      count_unjudged(Verdict::inconclusive, "answered once so, and then otherwise", result);
    return;
  }
  ++judged_;
  const std::string mark = sequence->mark(failing, result);
  if (!known_already(*sequence, failing, result, mark))
    look_into(std::move(sequence), failing, result, mark);
}

void Explorer::note_as_expected(const Sequence& sequence) {
  ++judged_;
  inventor_->done(sequence);
  for (std::size_t i = 0; i < sequence.parts(); ++i) {
    const Topic topic = sequence.topic(i);
    inventor_->note(topic, ++seen_[{topic.name, topic.kind}][sequence.outcome(i)]);
  }
}

/// What an interrupt or a device that is gone did to a sequence is told once, and not by it.
void Explorer::note_unjudged(const Sequence& sequence, const CaseResult& result) {
  if (!device_.alive()) return;
  count_unjudged(result.verdict, result.message, result);
  if (result.verdict != Verdict::blocked || inventor_->give_up(sequence)) return;
  barren_ += inventor_->can_invent() ? 1 : enough_barren;
}

void Explorer::count_unjudged(Verdict verdict, const std::string& why, const CaseResult& result) {
  Unjudged& same = unjudged_[{verdict, why}];
  if (same.times++ == 0) same.first = result;
}

/// What came once may have been the line: a device reads it so where it does so again, at the end
/// of the same requests, and all before it were answered as they had to be.
bool Explorer::learnt(const Sequence& sequence, std::size_t failing, const CaseResult& result) {
  const std::string id = fmt::format("explore/{}/again", sequences_);
  const std::size_t behind = sequence.parts() - failing - 1;
  const Sequence::Own begun = behind == 0 ? nullptr : sequence.without(failing + 1, behind);
  if (behind > 0 && (!begun || begun->parts() != failing + 1)) return false;
  const CaseResult again = run(begun ? *begun : sequence, id);
  if (!differs(again.verdict) || again.received_bytes != result.received_bytes) return false;
  if (failing > 0) {
    const Sequence::Own before = sequence.without(failing, behind + 1);
    if (!before || before->parts() != failing || run(*before, id).verdict != Verdict::pass)
      return false;
  }
  return inventor_->learn(sequence, failing, result);
}

/// It is one more of a finding; false where it may show that to be graver.
bool Explorer::known_already(const Sequence& sequence, std::size_t failing,
                             const CaseResult& result, const std::string& mark) {
  const auto same = same_.find(mark);
  if (same == same_.end()) {
    if (findings_.size() < most_findings) return false;
    count_unjudged(result.verdict, "differs, not looked into: there are 50 findings", result);
    return true;
  }
  Finding& finding = findings_.at(same->second);
  ++finding.shown_by[in_words(sequence.topic(failing))];
  const bool may_be_graver = finding.result.verdict != Verdict::fail &&
                             (result.verdict == Verdict::fail || finding.looks < most_looks);
  return !may_be_graver;
}

void Explorer::look_into(Sequence::Own sequence, std::size_t failing, const CaseResult& result,
                         const std::string& mark) {
  const std::string topic = in_words(sequence->topic(failing));
  const std::string long_id = id_of(*device_.protocol, mark);
  Shortener shortener([&](const Sequence& one) { return run(one, long_id + "/shorter"); },
                      device_.alive, result.verdict);
  const vectors::Case whole = sequence->as_case(long_id);
  const Sequence::Own found = shortener.shortest(std::move(sequence), failing);
  Finding finding = finding_of(*found, shortener, result, long_id);
  // What is left may tell more of what it is than what it was seen in.
  const std::string own_mark =
      finding.confirmed ? found->mark(found->failing_part(finding.result), finding.result) : mark;
  if (finding.confirmed)
    finding.shortest.id = finding.result.id = id_of(*device_.protocol, own_mark);
  else
    finding.shortest = whole;
  same_[mark] = same_[own_mark] = own_mark;
  finding.shown_by[topic] = 1;
  const auto [known, is_new] = findings_.try_emplace(own_mark, finding);
  if (is_new) return;
  Finding& same = known->second;
  ++same.shown_by[topic];
  ++same.looks;
  if (!finding.confirmed || same.result.verdict == Verdict::fail) return;
  same.shortest = std::move(finding.shortest);
  same.result = std::move(finding.result);
  same.confirmed = true;
}

Finding Explorer::finding_of(const Sequence& found, Shortener& shortener, CaseResult seen,
                             const std::string& id) {
  Finding finding;
  int shown = 0;
  while (shown < confirmations && device_.alive() && shortener.shows(found)) ++shown;
  finding.confirmed = shown == confirmations;
  finding.shortest = found.as_case(id);
  if (finding.confirmed) finding.result = device_.run(finding.shortest);
  finding.confirmed &= differs(finding.result.verdict);
  if (finding.confirmed) return finding;
  finding.result = std::move(seen);
  finding.result.verdict = Verdict::inconclusive;
  finding.result.message = "seen once, and not again: " + finding.result.message;
  finding.result.id = id;
  return finding;
}

}  // namespace fieldproof::explore
