// What a person at the bench reads: pure functions from results to text, and the sink that prints
// it.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "reports/results/sink.hpp"
#include "reports/text/failures.hpp"
#include "reports/text/tally.hpp"
#include "reports/text/timing_table.hpp"
#include "reports/text/unjudged.hpp"

namespace fieldproof::reports {

struct ConsoleOptions {
  results::Gate gate = {};
  bool verbose = false;   // -v: every case, with its exchange
  bool terminal = false;  // a moving progress line, and colour
  bool colour = true;     // on a terminal; false where NO_COLOR is set
  int width = 0;          // of the terminal: no line is wider; 0: a log, whose lines stay whole
};

/// What a run is about, before its first case: in lines of at most 100 columns, and of the
/// terminal's width.
std::string run_head(const results::RunInfo& run, const ConsoleOptions& options = {});

/// A case as it happens: one line, and the block of case_text.hpp, when it turns the gate red or
/// with -v; else nothing. Without the block where `again` is the finding that tells it in full, or
/// where it shall be a line.
std::string case_report(const results::CaseResult& result, const ConsoleOptions& options,
                        const text::Finding* again = nullptr, bool in_full = true);

/// The one line that moves. Only on a terminal: a log gets the cases that turn the gate red, and
/// the summary.
class Progress {
 public:
  explicit Progress(const ConsoleOptions& options) : options_(options) {}

  /// "[  12/1480] 1 red, 1468 to go, ~3 min  xgt_cnet/rss/two_words" over the line before it,
  /// before case `next_id` runs. `elapsed` counts from the start of the run. Empty where the line
  /// is younger than 20 ms: a terminal must not slow down cases of a tenth of a millisecond, while
  /// each case on a real line still shows.
  std::string line(const text::Tally& tally, std::size_t total, const std::string& next_id,
                   Duration elapsed);

  /// The same with this text.
  std::string line(std::string text, Duration elapsed);

  /// Removes the line before anything else is printed; empty where none stands.
  std::string erase();

 private:
  ConsoleOptions options_;
  Duration drawn_{};
  bool shown_ = false;
};

struct Summary {
  text::Tally tally;
  results::RunEnd end;
  text::Failures red;  // the cases that turned the gate red
  std::vector<std::pair<std::string, std::string>>
      reports;  // kind and path: {"junit", "fieldproof-out/junit.xml"}
  text::TimingTable::Rows timing = {};
  std::optional<results::SoakSummary> soak = {};
  text::Unjudged not_judged = {};  // SKIP, BLOCKED, INCONCLUSIVE
};

/// Counts of the verdicts that occur with their meaning, why the rest was not judged, what failed
/// again and again as one finding, the other red cases, exit code and its meaning, paths of the
/// reports.
std::string run_summary(const Summary& summary, const ConsoleOptions& options);

/// All of it as the run goes.
class ConsoleReport final : public results::Sink {
 public:
  using Print = void (*)(const std::string&);
  ConsoleReport(const ConsoleOptions& options, Print print)
      : options_(options), progress_(options), print_(print) {}

  void show_progress(std::size_t total, const std::string& next_id, Duration elapsed) {
    print_(progress_.line(summary_.tally, total, next_id, elapsed));
  }
  void show_progress(const std::string& text, Duration elapsed) {
    print_(progress_.line(text, elapsed));
  }
  /// A line for the engineer between the cases.
  void say(const std::string& line) { print_(progress_.erase() + folded(line + '\n')); }
  void erase_progress() { print_(progress_.erase()); }

  Status begin(const results::RunInfo& run) override;
  /// One that a soak only counts. The finding that it belongs to; nullptr: it is not red.
  const text::Finding* count(const results::CaseResult& result);
  Status add(const results::Delivery& one) override;
  Status end(const results::RunLog& log) override;

  void add_path(const std::string& kind, const std::string& path) {
    summary_.reports.emplace_back(kind, path);
  }
  const results::Gate& gate() const { return options_.gate; }
  const text::Tally& tally() const { return summary_.tally; }

 private:
  /// What is told of one more red case: of a flood the first alone.
  std::string red_case(const results::CaseResult& result, const text::Finding& finding);
  std::string folded(const std::string& text) const;

  ConsoleOptions options_;
  Progress progress_;
  Print print_;
  Summary summary_;
  text::TimingTable timing_;
  std::size_t in_full_ = 0, in_lines_ = 0;  // red cases that were told so
};

}  // namespace fieldproof::reports
