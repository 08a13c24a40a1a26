// Response times of a run in numbers: the same table on the console, in JUnit and in JSON. Its
// memory does not grow with the repetitions.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "reports/results/case_result.hpp"
#include "reports/results/response_times.hpp"

namespace fieldproof::text {

class TimingTable {
 public:
  void add(const results::CaseResult& result);

  using Rows = std::vector<std::pair<std::string, results::ResponseFigures>>;
  /// One row a case where there are at most `limit`, else a group of cases ("xgt_cnet/rss"), else a
  /// protocol.
  Rows rows(std::size_t limit = 20) const;
  /// {"cases": {...}, "groups": {...}}; without "cases" where there are more than `case_limit`.
  std::string json() const;

  static constexpr std::size_t case_limit = 10'000;

 private:
  std::map<std::string, results::ResponseTimes> cases_, groups_, protocols_;
  bool too_many_ = false;  // cases: their figures were given up
};

/// Aligned columns under a head line; empty without rows.
std::string timing_text(const TimingTable::Rows& rows);

}  // namespace fieldproof::text
