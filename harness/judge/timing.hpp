// When a frame, or the end of a link, came: limits, the silences in a frame, periods.
#pragma once

#include <string>
#include <vector>

#include "harness/exchange/transcript.hpp"
#include "harness/judge/findings.hpp"

namespace fieldproof::judging {

/// A limit, and what came of it.
struct Limit {
  std::string what;     // "answer"
  std::string after;    // "the request"
  bool stated = false;  // by the vector, not by the profile
  Duration limit{}, took{};
};
/// False: it was exceeded, or cannot be judged.
bool judge_limit(const Limit& one, const JudgeRules& rules, Findings& findings);

/// On a line that several drive: a reply that comes too soon.
void judge_turnaround(Duration took, const JudgeRules& rules, Findings& findings);

/// The longest silence inside a frame that is allowed, and what the link itself may add to it.
struct GapLimit {
  Duration limit{};
  Duration floor{};      // 0: it is in the limit
  bool of_case = false;  // the case is about this limit: what the link cannot show is not passed
};
void judge_gaps(const exchange::Received& received, const GapLimit& gap, Findings& findings);

/// What comes at the pace of a clock.
class Periods {
 public:
  void add(Duration every, const exchange::Received& previous, const exchange::Received& received,
           const JudgeRules& rules, Findings& findings);
  /// Minimum, median and maximum, as a note; then nothing is measured.
  void note(Duration every, Findings& findings);

 private:
  std::vector<Duration> measured_;
};

}  // namespace fieldproof::judging
