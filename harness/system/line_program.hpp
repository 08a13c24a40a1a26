// A program that the bench starts beside the device under test, and tells by lines on its standard
// input: --stimulus, --control.
#pragma once

#include <memory>
#include <string>

#include "harness/system/child_process.hpp"
#include "src/base/result.hpp"

namespace fieldproof::os {

class LineProgram {
 public:
  /// Starts `command` by the shell. `option` is what the user gave it as ("--stimulus"), for
  /// errors.
  static Result<std::unique_ptr<LineProgram>> start(const std::string& option,
                                                    const std::string& command);
  /// One line, without its newline. Errors say how the program ended.
  Status tell(const std::string& line);
  /// ChildProcess::answer.
  std::string answer(Duration patience) { return child_->answer(patience); }
  /// Starts it anew.
  Status restart();
  /// ChildProcess::how.
  std::string how() { return child_->how(); }

 private:
  std::string name_;  // "--stimulus 'COMMAND'"
  std::string command_;
  std::unique_ptr<ChildProcess> child_;
  UniqueFd input_;  // closed first: its end tells a program that reads to the end to stop
};

}  // namespace fieldproof::os
