// From what happened to a verdict: a pure function, the only place that decides.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "harness/exchange/prepared_case.hpp"
#include "harness/exchange/transcript.hpp"
#include "harness/vectors/binding.hpp"

namespace fieldproof::judging {

struct JudgeRules {
  double guard_band = 0.1;    // the last part of a limit that is MARGINAL
  Duration timing_floor{};    // a limit below it is INCONCLUSIVE
  Duration link_floor{};      // the part of it that is not the device's own answer time
  Duration gap_floor{};       // silence inside a frame that the link may make itself, by its driver
  Duration turnaround_min{};  // a reply that begins sooner collides with a partner that still
                              // drives the line
  Duration max_gap =
      4010417ns;  // silence allowed inside a reply (Cnet KO 4.3.1: 3.5 characters of 11 bits)
  Duration
      earliest{};  // below 0, on a real wire: a reply that begins earlier is not of this request
  bool gap_stated = false;      // by the profile: the floor of the link is not in it
  Duration period_tolerance{};  // of `every`; 0: a twentieth of it, or the timing floor where that
                                // is more
  vectors::Binding decisions;   // a missed one that binds is FAIL, else NON-STRICT

  /// The limits of a reply are a decision, too: what misses them is FAIL, else NON-STRICT.
  bool timing_binds() const { return decisions.holds(vectors::reply_time_decision); }
};

struct Judgement {
  results::Verdict verdict = results::Verdict::error;
  std::string message;
  std::vector<std::string> notes;
  const vectors::Step* failed = nullptr;  // the first step that was not as it should be
  const exchange::PreparedFrame* expected =
      nullptr;                  // of the failing step, the alternative that comes nearest
  results::Due due;             // of the failing step, where it waits for a frame
  exchange::Received received;  // what came instead
  std::vector<results::Difference> differences;
  std::map<std::string, std::string> readings;
  std::vector<double> response_ms;
};

Judgement judge(const exchange::PreparedCase& prepared, const exchange::Transcript& transcript,
                const JudgeRules& rules, const harness::Protocol& protocol);

/// A result that knows its case, and no verdict yet.
results::CaseResult result_of(const vectors::Case& source);
/// Notes where a case runs at another station than the manual's example names.
void note_transposition(const exchange::PreparedCase& prepared, results::CaseResult& result);
/// Writes a judgement into the result of its case.
void take_judgement(Judgement judgement, results::CaseResult& result);
/// Writes what happened into it, in notation too. What came is bounded, there and in the judgement
/// that it has: of a run of more than twice the protocol's longest frame there is an extract.
/// Bytes that came no further apart than `apart`, one after the other, are one line: a driver that
/// hands over each byte makes no frames of one byte.
void take_exchange(const exchange::Transcript& transcript, std::size_t longest_frame,
                   results::CaseResult& result, Duration apart = {});

/// The fields in which two frames differ, named by the protocol. `requests`: both are those of a
/// client, else replies.
std::vector<results::Difference> compare_frames(ByteView expected, ByteView received,
                                                const harness::Protocol& protocol, bool requests);

}  // namespace fieldproof::judging
