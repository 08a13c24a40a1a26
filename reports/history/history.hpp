// The runs of many days in one SQLite file. What thousands of runs have in common (names, messages,
// lists of verdicts and times) is kept once, found by its hash; the tables stand in
// history_file.cpp.
//   A run whose results are already there is not added again. Two programs may write at once: each
// run is one transaction. A file that is damaged, of a newer version, or no history, is never
// written to.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "reports/compare/compare.hpp"
#include "reports/history/storage/history_file.hpp"
#include "reports/history/storage/packed_run.hpp"
#include "src/base/result.hpp"

namespace fieldproof::history {

/// A row of `history list`, with the numbers of its lists: equal numbers are equal lists.
struct RunEntry {
  std::int64_t number = 0;  // by which the user names it, in the order of adding
  std::string device, firmware, protocols, vectors, tool;
  std::string started;           // as the run wrote it
  std::int64_t started_s = 0;    // since 1970
  std::optional<int> exit_code;  // nothing: killed
  bool complete = false;         // it came to its end, not interrupted, and is no shard
  double seconds = 0;
  text::Tally counts;   // results
  std::size_t red = 0;  // of them, by the gate of the run
  std::int64_t cases = 0, verdicts = 0, repetitions = 0, with_verdict = 0, topics = 0;
};

/// What stands in no list: the same in each run.
struct CaseFacts {
  std::string name, title, manual, section;
};

class History {
 public:
  /// As `open_history`.
  static Result<History> open(const std::string& path, Use use);

  struct Added {
    std::int64_t number = 0;
    bool is_new = false;
    std::string device;
  };
  Result<Added> add(const compare::RunSummary& run);

  /// All, or those of a device: the oldest first, by the time at which they started.
  Result<std::vector<RunEntry>> runs(const std::string& device = "");
  /// As `compare::summarize` made it when it was added, but for what stands in the vectors alone
  /// (titles, sections), which is as of the first run that had the case.
  Result<compare::RunSummary> summary(std::int64_t number);
  /// The last run before this one of the same device over the same protocols that came to its end,
  /// whatever its verdicts. `run` may have no cases yet.
  Result<std::optional<compare::RunSummary>> last_before(const compare::RunSummary& run);

  Result<Numbers> list(std::int64_t id);
  Result<std::vector<Repeated>> repeated(std::int64_t id);
  /// By their ids: `from_steps` of the list `cases` of a run.
  Result<std::vector<CaseFacts>> cases(const Numbers& ids);
  Result<std::string> text(std::int64_t id);

  const std::string& path() const { return path_; }

 private:
  History(std::string path, std::unique_ptr<Database> database)
      : path_(std::move(path)),
        database_(std::move(database)),
        list_(database_->prepare("SELECT bytes, hash FROM list WHERE id = ?")) {}

  /// By which a run is known again, whichever of its files it is read from.
  static std::string hash_of(const compare::RunSummary& run, const CaseLists& lists);
  static std::string protocols_of(const results::RunInfo& run);
  std::string_view read_bytes(std::int64_t id);  // until the next
  Numbers read_list(std::int64_t id);
  std::int64_t keep(const Numbers& numbers);
  std::int64_t keep(const std::string& text);
  std::int64_t keep_cases(const compare::RunSummary& run);
  std::int64_t keep_device(const std::string& device);
  std::int64_t insert(const compare::RunSummary& run, const CaseLists& lists,
                      const std::string& device, const std::string& hash, std::int64_t started);
  std::vector<std::string> texts(const Numbers& ids);
  std::vector<CaseFacts> read_cases(const Numbers& ids);

  std::string path_;
  std::unique_ptr<Database> database_;
  Statement list_;
};

}  // namespace fieldproof::history
