// The words of a command line: which command they name, with which options.
#pragma once

#include <functional>

namespace fieldproof::suites {

using Command = std::function<int()>;
/// Gives the exit code.
using Start = std::function<int(const Command&)>;

/// Reads the words and hands the command that they name to `start`. What asks for help, the version
/// or a completion is answered here, and so is what cannot be read: exit code 2.
int with_command(int argc, char** argv, const Start& start);

}  // namespace fieldproof::suites
