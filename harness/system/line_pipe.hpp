// Lines of text to the standard input of a child process.
#pragma once

#include <string>

#include "harness/system/unique_fd.hpp"
#include "src/base/result.hpp"

namespace fieldproof::os {

struct LinePipe {
  UniqueFd bench;  // written
  UniqueFd child;  // becomes its standard input
};

Result<LinePipe> open_line_pipe();

/// Writes `line` and a newline; false where nobody reads any more, or a reader has not read for
/// long.
bool write_line(int fd, const std::string& line);

}  // namespace fieldproof::os
