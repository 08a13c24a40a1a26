// The results of a run as they happen: one JSON object a line, so that whatever kills the run, what
// was judged is kept.
//   {"run":{...}}    first
//   {"case":{...}}   one a result
//   {"sample":{...}}, {"soak":{...}}   of a soak (soak.hpp)
//   {"end":{...}}    last; missing when the run was killed
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "reports/results/case_result.hpp"
#include "reports/results/soak.hpp"
#include "src/base/result.hpp"

namespace fieldproof::results {

/// Appends lines, each by one write(2): no buffer of ours stands between a result and the file.
/// The file is locked while the writer lives, so two runs cannot mix their lines.
class NdjsonWriter {
 public:
  /// Makes the file, or empties an old one. Errors name the path.
  static Result<NdjsonWriter> create(const std::string& path);

  NdjsonWriter(NdjsonWriter&& other) noexcept;
  NdjsonWriter& operator=(NdjsonWriter&& other) noexcept;
  ~NdjsonWriter();

  /// Text that is not UTF-8 is kept readable (U+FFFD for what is not). After an error the file ends
  /// with its last complete line, and writing may go on.
  Status write(const RunInfo& info);
  Status write(const CaseResult& result);
  Status write(const SoakSample& sample);
  Status write(const SoakSummary& soak);
  Status write(const RunEnd& end);

  const std::string& path() const { return path_; }

 private:
  NdjsonWriter(std::string path, int fd) : path_(std::move(path)), fd_(fd) {}
  Status write_line(const std::string& line);
  void swap(NdjsonWriter& other) noexcept;

  std::string path_;
  int fd_ = -1;
};

/// What stands around the results of a file.
struct RunLog {
  RunInfo run;
  std::optional<RunEnd> end;             // nothing: the run was killed, or is not over
  std::vector<SoakSample> samples = {};  // of a soak, in order
  std::optional<SoakSummary> soak = {};  // nothing: no soak, or a killed one
  std::size_t results = 0;
  bool truncated = false;  // the last line is incomplete and was left out
};

/// Reads a file line by line and hands over each result; memory does not grow with their number.
/// An incomplete last line is tolerated; any other damage is an error that names file and line.
Result<RunLog> read_ndjson(const std::string& path,
                           const std::function<void(const CaseResult&)>& on_result);

}  // namespace fieldproof::results
