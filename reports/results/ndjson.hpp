// The results of a run as they happen: one JSON object a line, so that whatever kills the run, what
// was judged is kept.
//   {"run":{...}}    first
//   {"case":{...}}   one a result
//   {"sample":{...}}, {"soak":{...}}   of a soak (soak.hpp)
//   {"end":{...}}    last; missing when the run was killed
#pragma once

#include <functional>
#include <string>

#include "reports/results/sha256.hpp"
#include "reports/results/sink.hpp"
#include "src/base/result.hpp"

namespace fieldproof::results {

/// Appends lines, each by one write(2): no buffer of ours stands between a result and the file.
/// The file is locked while the writer lives, so two runs cannot mix their lines.
class NdjsonWriter final : public Sink {
 public:
  /// Makes the file, or empties an old one. Errors name the path.
  static Result<NdjsonWriter> create(const std::string& path);

  NdjsonWriter(NdjsonWriter&& other) noexcept;
  NdjsonWriter& operator=(NdjsonWriter&& other) noexcept;
  ~NdjsonWriter() override;

  /// Text that is not UTF-8 is kept readable (U+FFFD for what is not). After an error the file ends
  /// with its last complete line, and writing may go on.
  Status begin(const RunInfo& run) override;
  Status add(const Delivery& one) override;
  Status add(const SoakSample& sample);
  Status add(const SoakSummary& soak);
  Status end(const RunLog& log) override;

  /// Of all that was written.
  std::string sha256() const { return sha256_.digits(); }

 private:
  NdjsonWriter(std::string path, int fd) : path_(std::move(path)), fd_(fd) {}
  Status write_line(const char* key, const std::string& json);
  void swap(NdjsonWriter& other) noexcept;

  std::string path_;
  int fd_ = -1;
  std::string line_;  // its room, from line to line
  Sha256 sha256_;
};

/// Reads a file line by line and hands all of it to the sink; memory does not grow with the
/// results. An incomplete last line is tolerated; any other damage is an error that names file and
/// line, and the sink does not come to its end.
Result<RunLog> replay(const std::string& path, Sink& sink);

/// The results alone.
Result<RunLog> read_ndjson(const std::string& path,
                           const std::function<void(const CaseResult&)>& on_result);

}  // namespace fieldproof::results
