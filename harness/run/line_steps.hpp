// A run over a line matrix: at each step the device is reconfigured, the endpoint opened anew and
// the cases run again.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "harness/bench/benches.hpp"
#include "harness/run/run_plan.hpp"

namespace fieldproof::run {

class LineSteps {
 public:
  /// `benches` are open, set for the first step. `command`: of --reconfigure; empty: the engineer
  /// is asked.
  LineSteps(const RunPlan& plan, bench::Benches& benches, std::string command)
      : plan_(plan), benches_(benches), command_(std::move(command)) {}

  /// Makes the device and the bench ready for a step. What it is not ready for is BLOCKED then; an
  /// error ends the run.
  Status enter(std::size_t step,
               const std::function<Result<std::string>(bench::Benches&)>& measure_floor);
  std::optional<std::size_t> current() const { return current_; }
  /// Is there anything to talk to at this step?
  bool live() const { return blocked_.empty(); }
  /// "38400-8N1, step 2 of 4: floor 20.0 ms", or why it is blocked.
  const std::string& remark() const { return remark_; }

  results::CaseResult run(const vectors::Case& source);

 private:
  /// Empty: the device is ready; else why it is not.
  Result<std::string> reconfigure(const line::LineSettings& step, std::size_t number);
  Status open(const line::LineSettings& step);
  std::string name() const { return line::to_string(plan_.matrix[*current_]); }
  std::string names_other_line(const vectors::Case& source) const;
  results::CaseResult decline(const vectors::Case& source, results::Verdict verdict,
                              const std::string& why) const;
  std::string replay(const std::string& id) const;

  const RunPlan& plan_;
  bench::Benches& benches_;
  std::string command_;
  std::optional<std::size_t> current_;
  std::string blocked_, remark_;
  std::string quit_;  // why no further step is entered
};

}  // namespace fieldproof::run
