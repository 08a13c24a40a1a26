// A command of the engineer's that prepares the bench, and the engineer himself at the terminal.
// Both can be interrupted.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "src/base/result.hpp"

namespace fieldproof::os {

/// Runs `command` by the shell with `arguments` behind it, and waits for its end. Its output is the
/// tool's stderr, its input nothing. Errors: it could not start, or its exit status is not 0;
/// Ctrl-C ends it.
Status run_hook(const std::string& command, const std::vector<std::string>& arguments,
                const std::vector<std::pair<std::string, std::string>>& environment);

/// Writes `question` to stderr and reads a line from stdin. Errors: interrupted, or stdin has
/// ended.
Result<std::string> ask(const std::string& question);

}  // namespace fieldproof::os
