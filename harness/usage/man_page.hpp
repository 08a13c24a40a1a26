// The man page.
#pragma once

#include <string>

#include "harness/usage/usage.hpp"

namespace fieldproof::usage {

struct Release {
  std::string version, date;  // "0.1.0", "2026-11-23"
};

/// In man(7): each command with all that its help says.
std::string man_page(const Command& tool, const Release& release);

}  // namespace fieldproof::usage
