// Why cases were not judged: a line a reason, for people.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "reports/results/case_result.hpp"

namespace fieldproof::text {

struct UnjudgedReason {
  results::Verdict verdict = results::Verdict::blocked;
  std::size_t cases = 0;
  std::string text;  // of BLOCKED what would let them run (remedy.hpp), else the reason
};

class Unjudged {
 public:
  void add(const results::CaseResult& result);
  /// BLOCKED, INCONCLUSIVE and SKIP, in this order; of each the greatest first.
  std::vector<UnjudgedReason> reasons() const;

 private:
  std::map<std::pair<results::Verdict, std::string>, UnjudgedReason> known_;
};

}  // namespace fieldproof::text
