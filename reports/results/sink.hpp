// Where the results of a run go, once and in the order in which they happen: the file of results
// and each report take them from the run itself, or from such a file (`replay`), in the same way.
//   begin, then add for each result, then end
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "reports/results/case_result.hpp"
#include "reports/results/soak.hpp"
#include "src/base/result.hpp"

namespace fieldproof::results {

/// What stands around the results of a run.
struct RunLog {
  RunInfo run;
  std::optional<RunEnd> end;             // nothing: the run was killed, or is not over
  std::vector<SoakSample> samples = {};  // of a soak, in order
  std::optional<SoakSummary> soak = {};  // nothing: no soak, or a killed one
  std::size_t results = 0;
  bool truncated = false;  // the last line of its file is incomplete and was left out
  std::string sha256;      // of its file, as far as it was read or written
};

/// A result on its way. Its JSON text is made once, for whoever asks.
class Delivery {
 public:
  /// `result` outlives it.
  explicit Delivery(const CaseResult& result) : result_(result) {}
  const CaseResult& operator*() const { return result_; }
  const CaseResult* operator->() const { return &result_; }
  const std::string& json() const;

 private:
  const CaseResult& result_;
  mutable std::string json_;
};

/// Takes the results of one run. Keeps no more of a result than its report shows of it, so that
/// memory does not grow with the repetitions. An error names its file; after one nothing more
/// comes.
class Sink {
 public:
  virtual ~Sink() = default;

  virtual Status begin(const RunInfo& run) = 0;
  virtual Status add(const Delivery& one) = 0;
  /// Nothing more comes: whatever the run came to, the report is put in its place. Without it there
  /// is none.
  virtual Status end(const RunLog& log) = 0;
};

/// Hands on to several. What one of them cannot take, or throws at, stops that one alone.
class Sinks final : public Sink {
 public:
  void attach(std::unique_ptr<Sink> sink) { sinks_.push_back(std::move(sink)); }

  /// Always ok: see `troubles`.
  Status begin(const RunInfo& run) override;
  Status add(const Delivery& one) override;
  /// In the order in which they were attached; each is told what those before it could not.
  Status end(const RunLog& log) override;

  /// Of those that stopped, in the order in which they did.
  const std::vector<std::string>& troubles() const { return troubles_; }

 private:
  Status each(const auto& call);

  std::vector<std::unique_ptr<Sink>> sinks_;  // that still take
  std::vector<std::string> troubles_;
};

}  // namespace fieldproof::results
