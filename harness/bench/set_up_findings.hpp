// Set-up writes that the device does not take: never the fault of what a case tests, and yet not
// to be lost. One result for each way in which they fail, however many cases they block.
#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "reports/results/case_result.hpp"

namespace fieldproof::bench {

/// The id of such a result, before its protocol and number; no case has it.
inline constexpr std::string_view set_up_result = "set_up/";

/// How the message of a case ends that was blocked without one more trial.
inline constexpr std::string_view not_tried =
    "; not tried, as the last writes that set up a case were not answered";

class SetUpFindings {
 public:
  /// Takes notice of a case that its set-up has blocked, and whether others were judged.
  void note(const results::CaseResult& result);
  /// FAIL for each way: what was sent, what came, and the cases that were blocked by it. One write
  /// that was not answered, where others were judged, is INCONCLUSIVE: an answer can be lost.
  std::vector<results::CaseResult> results() const;

 private:
  struct Finding {
    results::CaseResult first;  // case
    std::size_t cases = 0;
  };
  std::map<std::string, Finding> findings_;  // by what the device did
  std::set<std::string> judged_;             // protocols of which a case was judged
};

}  // namespace fieldproof::bench
