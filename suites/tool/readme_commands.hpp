// The commands that a Markdown text prints: in its blocks of code, in its recipes for CI, between
// backticks and in a table of commands.
#pragma once

#include <string>
#include <vector>

namespace fieldproof::tool_tests {

/// In their order, each once; without prompt and remark, continued lines as one. A command that
/// stays in the background ends with " &". The table is that whose head says `command`; what it
/// names is a command of `fieldproof`.
std::vector<std::string> commands_of(const std::string& markdown);

}  // namespace fieldproof::tool_tests
