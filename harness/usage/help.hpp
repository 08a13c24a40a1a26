// What --help prints.
#pragma once

#include <cstddef>
#include <string>

#include "harness/usage/usage.hpp"

namespace fieldproof::usage {

/// Description, usage, options in their groups and commands, in lines of `width`.
std::string help_text(const Command& command, std::size_t width);

}  // namespace fieldproof::usage
