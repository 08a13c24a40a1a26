// Keeps a soak in little memory: counts and response times by case and by stretch of time; never a
// result.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "reports/results/case_result.hpp"
#include "reports/results/soak.hpp"

namespace fieldproof::run {

/// Times are seconds since the start of the run, and only grow.
class SoakLog {
 public:
  SoakLog(double planned_s, results::Gate gate) : planned_s_(planned_s), gate_(gate) {}

  bool over(double now) const { return now >= planned_s_; }

  /// Notes one repetition. Should its result be written in full? The first of each case is, and so
  /// are failures, as far as there is room for them.
  bool take(const results::CaseResult& result, double now);

  /// The stretch since the last sample, where one is due: about 500 in all.
  std::optional<results::SoakSample> due_sample(double now);

  /// In each round so far something was executed; else there is nothing to soak.
  bool idle(int round) const { return round > 0 && judged_ == 0; }

  results::SoakSummary summary(double now) const;

  static constexpr std::uint64_t failures_a_case = 20, failures_in_all = 1000;

 private:
  struct Stretch {
    double from = 0;
    std::uint64_t judged = 0, failed = 0;
    results::ResponseTimes times = {};
    void add(const Stretch& other);
  };
  struct OneCase {
    std::map<std::string, std::uint64_t> counts;
    results::ResponseTimes times;
    std::uint64_t written = 0;  // failures
  };
  void note(const results::CaseResult& result, double now, bool judged, bool failed);
  Stretch& stretch_at(double now);
  results::SoakSample tenth(double from, double to) const;

  double planned_s_;
  results::Gate gate_;
  std::map<std::string, OneCase> cases_;
  std::vector<Stretch> stretches_;  // of equal length; when there are too many, two become one
  double length_ = 0.001;
  Stretch since_sample_;
  results::ResponseTimes times_;
  int rounds_ = 0;
  std::uint64_t judged_ = 0, failed_ = 0, written_ = 0, unwritten_ = 0;
};

}  // namespace fieldproof::run
