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
/// written as results happen, the others at the end.
using ReportPaths = std::vector<std::pair<std::string, std::string>>;

/// Where the reports of a run go: into the folder `out`, which is made, but for those with a path
/// of their own.
Result<ReportPaths> make_report_paths(const std::string& out, const std::string& json,
                                      const std::string& junit, const std::string& html);

/// A sink for each of them but the file of results.
results::Sinks sinks_for(const ReportPaths& paths);

/// As the terminal is.
reports::ConsoleOptions console_options(const results::Gate& gate, bool verbose);

void print(const std::string& text);
/// What a person reads: in lines that the terminal has room for.
void tell(const std::string& text);

class RunReport {
 public:
  /// Begins the file of results. Errors name it.
  static Result<RunReport> create(ReportPaths paths, const reports::ConsoleOptions& console);

  /// One more that takes the results; before `begin`.
  void attach(std::unique_ptr<results::Sink> sink) { reports_.attach(std::move(sink)); }

  /// Writes and prints what the run is about.
  Status begin(const results::RunInfo& info);
  void show_progress(std::size_t total, const std::string& next_id) {
    console_.show_progress(total, next_id, std::chrono::steady_clock::now() - started_);
  }
  void show_progress(const std::string& text) {
    console_.show_progress(text, std::chrono::steady_clock::now() - started_);
  }
  /// False: it could not be written, stop here. A soak counts most of its results and writes few.
  bool add(const results::CaseResult& result, bool written = true);
  bool add(const results::SoakSample& sample) {
    return kept(writer_.add(log_.samples.emplace_back(sample)));
  }
  bool add(const results::SoakSummary& soak) { return kept(writer_.add(log_.soak.emplace(soak))); }
  /// A line for the engineer between the cases.
  void say(const std::string& line) { console_.say(line); }

  struct End {
    std::string trouble;  // empty, or why the run stopped early
    bool interrupted = false;
    std::string worse;         // than which baseline, and in what; empty: not worse
    double seconds = -1;       // that the run took; negative: since this report was begun
    std::string hint;          // which option would let it judge more
    std::string not_restored;  // what a real device does not hold as before, and what to type
  };
  /// As the file of results and the reports tell it.
  results::RunEnd ended(const End& end) const;
  /// Writes the end and the reports, prints the summary; the exit code of the run.
  int finish(const End& end);

  const text::Tally& tally() const { return console_.tally(); }
  const results::Gate& gate() const { return console_.gate(); }
  /// The file of results.
  const std::string& path() const { return paths_.front().second; }
  void add_path(const std::string& kind, const std::string& path) {
    paths_.emplace_back(kind, path);
  }

 private:
  RunReport(ReportPaths paths, const reports::ConsoleOptions& console, results::NdjsonWriter writer)
      : paths_(std::move(paths)),
        console_(console, print),
        writer_(std::move(writer)),
        reports_(sinks_for(paths_)) {}
  /// False: it could not be written.
  bool kept(const Status& written);

  ReportPaths paths_;
  reports::ConsoleReport console_;
  results::NdjsonWriter writer_;
  results::Sinks reports_;
  results::RunLog log_;  // so far
  std::chrono::steady_clock::time_point started_ = std::chrono::steady_clock::now();
  std::string write_trouble_;
};

}  // namespace fieldproof::run
