// --stimulus: the program that makes a device under test ask. It is told by lines on its standard
// input.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "harness/system/child_process.hpp"
#include "src/base/result.hpp"

namespace fieldproof::exchange {

/// Takes one line, without its newline.
using TellStimulus = std::function<Status(const std::string& line)>;

class Stimulus {
 public:
  /// Starts `command` by the shell.
  static Result<std::unique_ptr<Stimulus>> start(const std::string& command);
  /// Errors say how the program ended.
  Status tell(const std::string& line);
  /// What it says to the first line; empty: nothing within that time.
  std::string answer(Duration patience) { return child_->answer(patience); }
  /// Starts it anew.
  Status restart();

 private:
  std::string command_;
  std::unique_ptr<os::ChildProcess> child_;
  os::UniqueFd input_;  // closed first: its end tells a program that reads to the end to stop
};

}  // namespace fieldproof::exchange
