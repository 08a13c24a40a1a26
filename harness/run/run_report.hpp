// What a run leaves behind: each result as it happens, the reports at its end, and its exit code.
#pragma once

#include <chrono>
#include <string>
#include <utility>
#include <vector>

#include "reports/console.hpp"
#include "reports/results/ndjson.hpp"

namespace fieldproof::run {

/// Kind and path: {"results", "out/results.ndjson"}, {"json", ...}, {"junit", ...}. The first is
/// what the others derive from.
using ReportPaths = std::vector<std::pair<std::string, std::string>>;

/// Where the reports of a run go: into the folder `out`, which is made, but for those with a path
/// of their own.
Result<ReportPaths> make_report_paths(const std::string& out, const std::string& json,
                                      const std::string& junit, const std::string& html);

/// Derives the reports from the results; 0, or the exit code of what went wrong (and was said).
int derive_reports(const std::string& ndjson, const ReportPaths& reports,
                   const results::Gate& gate);

/// As the terminal is.
reports::ConsoleOptions console_options(const results::Gate& gate, bool verbose);

void print(const std::string& text);

class RunReport {
 public:
  /// Begins the file of results. Errors name it.
  static Result<RunReport> create(ReportPaths paths, const reports::ConsoleOptions& console);

  /// Writes and prints what the run is about.
  Status begin(const results::RunInfo& info);
  void show_progress(std::size_t total, const std::string& next_id) {
    print(progress_.line(tally_, total, next_id, std::chrono::steady_clock::now() - started_));
  }
  /// False: it could not be written, stop here. A soak counts most of its results and writes few.
  bool add(const results::CaseResult& result, bool written = true);
  bool add(const results::SoakSample& sample);
  bool add(const results::SoakSummary& soak);
  /// A line for the engineer between the cases.
  void say(const std::string& line) { print(progress_.erase() + line + '\n'); }

  struct End {
    std::string trouble;  // empty, or why the run stopped early
    bool interrupted = false;
    bool worse = false;        // than a baseline: fails a gate that was met
    double seconds = -1;       // that the run took; negative: since this report was begun
    std::string not_restored;  // what a real device does not hold as before, and what to type: a
                               // gate that was met is trouble
  };
  /// Writes the end and the reports, prints the summary; the exit code of the run.
  int finish(const End& end);

  const text::Tally& tally() const { return tally_; }
  const results::Gate& gate() const { return console_.gate; }
  const ReportPaths& paths() const { return paths_; }
  void add_path(const std::string& kind, const std::string& path) {
    other_paths_.emplace_back(kind, path);
  }

 private:
  RunReport(ReportPaths paths, const reports::ConsoleOptions& console, results::NdjsonWriter writer)
      : paths_(std::move(paths)),
        console_(console),
        progress_(console),
        writer_(std::move(writer)) {}
  int code(const End& end) const;

  ReportPaths paths_, other_paths_;
  reports::ConsoleOptions console_;
  reports::Progress progress_;
  results::NdjsonWriter writer_;
  std::chrono::steady_clock::time_point started_ = std::chrono::steady_clock::now();
  text::Tally tally_;
  text::TimingTable timing_;
  std::optional<results::SoakSummary> soak_;
  std::vector<std::string> red_;
  bool keep(const Status& written);
  std::string write_trouble_;
};

}  // namespace fieldproof::run
