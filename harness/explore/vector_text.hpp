// A finding as a vector file that `run --vectors` takes.
#pragma once

#include <string>

#include "harness/vectors/case.hpp"

namespace fieldproof::explore {

/// Of a case whose steps have one frame each.
std::string vector_text(const vectors::Case& source);

}  // namespace fieldproof::explore
