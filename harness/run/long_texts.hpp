// What a run says at length is said once: a note of thousands of digits in each of a thousand
// results would be what the reports consist of.
#pragma once

#include <map>
#include <string>
#include <string_view>

#include "reports/results/case_result.hpp"

namespace fieldproof::run {

/// At most about a thousand characters: the middle of a longer text is left out, and counted.
std::string bounded(std::string_view text);

/// What a run says at its end of memory that is not as it was (Benches::put_back), and of writes
/// that may have changed some (Benches::doubtful_writes).
std::string not_restored(const std::string& places, const std::string& journal);
std::string not_sure(const std::string& writes);

class LongTexts {
 public:
  /// Message, differences and notes are bounded. A long note that an earlier case had is told by
  /// its beginning, and where it stands.
  void shorten(results::CaseResult& result);
  /// Of hundreds of frames that were as they should be the first and the last stay.
  static void shorten_exchange(results::CaseResult& result);

 private:
  std::map<std::string, std::string> seen_;  // bounded note: id of its first case
};

}  // namespace fieldproof::run
