// A report is there whole or not at all: written beside its place, then renamed.
#pragma once

#include <fstream>
#include <memory>
#include <string>

#include "src/base/result.hpp"

namespace fieldproof::text {

class ReportFile {
 public:
  /// Opens a temporary file in the folder of `path`. Errors name `path`. What is no regular file (a
  /// pipe, /dev/null) is written in place: renaming would put a file where a device was.
  static Result<ReportFile> create(const std::string& path);

  ReportFile(ReportFile&&) = default;
  ReportFile& operator=(ReportFile&&) = delete;
  /// Without commit() the temporary file is removed and an old report stays as it was.
  ~ReportFile();

  std::ostream& out() { return *stream_; }
  /// Writes what is left and puts the file in its place.
  Status commit();

 private:
  ReportFile(std::string path, std::string temporary);

  std::string path_;
  std::string temporary_;                  // equal to path_: written in place
  std::unique_ptr<std::ofstream> stream_;  // nothing once committed or moved
};

}  // namespace fieldproof::text
