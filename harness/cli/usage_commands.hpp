// What the tool says about its own command line: help, man page, completion.
#pragma once

#include <string>
#include <vector>

#include "harness/protocols.hpp"

namespace CLI {
class App;
}

namespace fieldproof::cli {

/// Help of this command and those added below it from now on: in groups, as wide as the terminal.
void format_help(CLI::App& app);

/// `man`.
int man_command(const CLI::App& app);

/// `completion SHELL`.
int completion_command(const CLI::App& app, const std::string& shell);

/// `__complete WORD...`, which the scripts of the shells ask.
int complete_command(const CLI::App& app, const std::vector<std::string>& words,
                     const harness::Protocols& protocols);

}  // namespace fieldproof::cli
