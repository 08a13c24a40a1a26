// What changed between runs: two firmware versions, two modules, yesterday and today.
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "reports/compare/result_file.hpp"
#include "reports/results/sink.hpp"
#include "reports/results/verdict.hpp"
#include "reports/text/tally.hpp"

namespace fieldproof::compare {

/// What one run has of one case, its repetitions together.
struct CaseSummary {
  results::Verdict verdict = results::Verdict::error;  // the gravest
  std::string message;                                 // of that
  std::string title, manual, section;
  int rev = 0;  // 0: the file does not say
  std::size_t repetitions = 0;
  std::size_t with_verdict = 0;     // repetitions that came to `verdict`
  std::vector<double> response_ms;  // of all repetitions
  double timing_floor_ms = 0;       // what the link cannot tell apart
};

struct RunSummary {
  std::string path;
  results::RunInfo run;
  std::optional<results::RunEnd> end;
  results::Gate gate;  // as the run was judged
  text::Tally tally;   // results
  std::map<std::string, CaseSummary> cases;
};
RunSummary summarize(const ResultFile& file);
/// The same of a run as it happens, but for its path and its end. `into` outlives the sink.
std::unique_ptr<results::Sink> summarizer(RunSummary& into);

/// In the order in which they are told.
enum class Change {
  newly_failing,     // red now, and not before
  weaker,            // not red, but NON-STRICT or MARGINAL where it was better
  no_longer_judged,  // held, and now SKIP, BLOCKED or INCONCLUSIVE
  newly_passing,     // red before, and holds
  other_reason,      // red in both, for another reason
  other_verdict,     // any other change of verdict: nothing got worse by it
  added,             // in the new run alone
  removed,           // in the old run alone
  revised            // the vector asserts something else (`rev`): not comparable
};
inline constexpr std::array<Change, 9> all_changes = {
    Change::newly_failing, Change::weaker,       Change::no_longer_judged,
    Change::newly_passing, Change::other_reason, Change::other_verdict,
    Change::added,         Change::removed,      Change::revised};
/// "newly failing"
std::string to_string(Change change);
/// "red now, and not before"
std::string meaning(Change change);
/// Does it turn the comparison red? The first three do.
bool got_worse(Change change);

struct CaseChange {
  std::string id;
  Change change = Change::other_verdict;
  const CaseSummary* before = nullptr;  // nullptr: added; into the RunSummary
  const CaseSummary* after = nullptr;   // nullptr: removed
};

/// A case whose reply times shifted by more than chance, and by enough to matter.
struct TimeShift {
  std::string id;
  double before_ms = 0, after_ms = 0;  // medians
  double shift_ms = 0;                 // Hodges-Lehmann; positive: slower
  double p = 1, corrected_p = 1;
  std::size_t replies_before = 0, replies_after = 0;
};

/// What was tested, so that "no shift" can be told from "could not be seen".
struct TimingTest {
  static constexpr double alpha = 0.05;  // chance of even one false alarm in the whole comparison
  static constexpr double least_share = 0.05;  // of the old median
  static constexpr double least_ms = 0.5;
  static constexpr std::size_t least_replies = 4;  // fewer cannot reach alpha
  std::size_t tested = 0;                          // cases
  std::size_t too_few = 0;                         // cases with reply times, but too few of them
  std::size_t exact = 0;                           // tested by the exact distribution
};

struct Comparison {
  const RunSummary* before = nullptr;
  const RunSummary* after = nullptr;
  std::vector<CaseChange> changes;  // in the order of Change, then of ids
  std::vector<TimeShift> shifts;    // slower first, the largest first
  TimingTest timing;
  std::size_t unchanged = 0;  // cases
  std::size_t count(Change change) const;
  std::size_t slower() const;
  bool worse() const;
};

/// Points into both, which must outlive it.
Comparison compare(const RunSummary& before, const RunSummary& after);

/// One row a case over all runs, the rows that differ first.
struct MatrixRow {
  std::string id;
  std::vector<const CaseSummary*> cells;  // one a run; nullptr: not in it
  bool differs = false;
};
std::vector<MatrixRow> matrix(const std::vector<RunSummary>& runs);

/// The first run against each other one.
struct ComparisonSet {
  explicit ComparisonSet(std::vector<RunSummary> all);
  ComparisonSet(const ComparisonSet&) = delete;
  ComparisonSet& operator=(const ComparisonSet&) = delete;

  std::vector<RunSummary> runs;         // at least two
  std::vector<Comparison> comparisons;  // runs[0] with runs[i + 1]
  std::vector<MatrixRow> rows;
  bool worse() const;
  /// "A", "B", ...: how tables name the runs.
  static std::string letter(std::size_t run);
};

/// How the test of reply times works, with its numbers.
std::string describe(const TimingTest& timing);
/// "2 newly failing, 1 slower", or "nothing got worse".
std::string outcome(const Comparison& comparison);

}  // namespace fieldproof::compare
