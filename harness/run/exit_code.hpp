// How the tool ends, and what it says then.
#pragma once

#include <string>

#include "harness/system/shell_word.hpp"

namespace fieldproof::run {

/// Exit codes, in order of precedence where several apply: usage, interrupted, trouble, failed,
/// nothing, absent, ok.
namespace exit_code {
inline constexpr int ok = 0, failed = 1, usage = 2, trouble = 3, nothing = 4, absent = 77,
                     interrupted = 130;
}

using os::shell_word;

/// Prints "fieldproof: MESSAGE" to stderr and returns `code`.
int complain(const std::string& message, int code);

}  // namespace fieldproof::run
