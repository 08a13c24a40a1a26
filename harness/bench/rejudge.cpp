#include "harness/bench/rejudge.hpp"

#include <fmt/format.h>
#include <algorithm>

#include "harness/judge/recording.hpp"
#include "harness/safety/placement.hpp"
#include "harness/safety/transposition.hpp"

namespace fieldproof::bench {

using results::Verdict;

namespace {

bool is_frame(const results::Event& event) { return event.kind != results::Event::Kind::note; }

/// A result that was waived is judged by what it was before.
Verdict before_waiver(Verdict verdict) {
  return verdict == Verdict::xfail ? Verdict::fail : verdict;
}

Rejudge::Outcome not_judged(const results::CaseResult& recorded, const std::string& why) {
  Rejudge::Outcome outcome{recorded, why};
  const bool exchanged =
      std::ranges::any_of(recorded.exchange, is_frame) && recorded.verdict != Verdict::error;
  outcome.result.verdict = exchanged ? Verdict::inconclusive : before_waiver(recorded.verdict);
  if (exchanged) outcome.result.message = "cannot be judged again: " + why;
  return outcome;
}

}  // namespace

Rejudge::Rejudge(const vectors::VectorSet& vectors, Profile profile,
                 const harness::Protocols& protocols)
    : profile_(std::move(profile)), protocols_(protocols) {
  for (const vectors::Case& one : vectors.cases) cases_[one.id] = &one;
}

Rejudge::Outcome Rejudge::judge(const results::CaseResult& recorded) {
  const auto source = cases_.find(recorded.id);
  if (source == cases_.end()) return not_judged(recorded, "the vector is gone");
  const harness::Protocol* protocol = protocols_.find(source->second->protocol);
  if (!protocol)
    return not_judged(recorded, fmt::format("there is no protocol '{}'", source->second->protocol));
  // On a real device the case may have been moved, by addresses that its configuration gives a
  // meaning.
  const Result<std::unique_ptr<harness::Protocol>> configured =
      protocol->configured(profile_.model, profile_.config);
  const harness::Protocol& declared = configured && *configured ? **configured : *protocol;
  const Result<exchange::PreparedCase> as_printed =
      exchange::prepare(*source->second, recorded.recording.station, *protocol, {protocols_});
  if (!as_printed) return not_judged(recorded, as_printed.error().message);
  // An emulated device took its memory as the vector has it.
  const Result<std::optional<vectors::Case>> placed = safety::placed_case(*as_printed, declared);
  const bool elsewhere = placed && *placed && !judging::replay(recorded, *as_printed, {});
  const Result<vectors::Case> moved =
      safety::moved_case(elsewhere ? **placed : *source->second, recorded.recording.station,
                         recorded.recording.moves, declared);
  if (!moved) return not_judged(recorded, moved.error().message);
  const Result<exchange::PreparedCase> prepared =
      exchange::prepare(*moved, recorded.recording.station, *protocol, {protocols_});
  if (!prepared) return not_judged(recorded, prepared.error().message);
  const Result<exchange::Transcript> transcript =
      judging::replay(recorded, *prepared, profile_.response_max);
  if (!transcript) return not_judged(recorded, transcript.error().message);

  Outcome outcome{judging::result_of(*source->second), ""};
  results::CaseResult& result = outcome.result;
  for (const results::Move& move : recorded.recording.moves)
    result.notes.push_back(safety::note_of(move, declared));
  judging::note_transposition(*prepared, result);
  judging::JudgeRules rules;
  rules.guard_band = profile_.guard_band;
  rules.decisions = profile_.decisions;
  rules.timing_floor = std::max(profile_.floor, recorded.recording.timing_floor);
  rules.turnaround_min = profile_.turnaround_min;
  rules.earliest = recorded.recording.earliest;
  rules.gap_floor = recorded.recording.gap_floor;
  rules.gap_stated = profile_.max_gap > 0ns;
  rules.max_gap = profile_.max_gap > 0ns ? profile_.max_gap : recorded.recording.max_gap;
  rules.period_tolerance = recorded.recording.period_tolerance;
  judging::take_judgement(fieldproof::judging::judge(*prepared, *transcript, rules, *protocol),
                          result);
  result.line = recorded.line;
  result.repeat = recorded.repeat;
  result.seconds = recorded.seconds;
  result.exchange = recorded.exchange;
  result.recording = recorded.recording;
  result.trace = recorded.trace;
  readings_.note(result);
  return outcome;
}

}  // namespace fieldproof::bench
