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
  /// `case_limit`: of more cases than these no row is kept.
  explicit TimingTable(std::size_t case_limit) : case_limit_(case_limit) {}
  TimingTable() = default;

  void add(const results::CaseResult& result);

  using Rows = std::vector<std::pair<std::string, results::ResponseFigures>>;
  /// One row a case where there are at most `limit`, else a group of cases ("xgt_cnet/rss"), else a
  /// protocol.
  Rows rows(std::size_t limit = 20) const;
  /// {"cases": {...}, "groups": {...}}; without "cases" where there are too many.
  std::string json() const;

 private:
  std::size_t case_limit_ = 20;
  std::map<std::string, results::ResponseTimes> cases_, groups_, protocols_;
  bool too_many_ = false;  // cases: their figures were given up
};

/// Aligned columns under a head line; empty without rows.
std::string timing_text(const TimingTable::Rows& rows);

}  // namespace fieldproof::text
