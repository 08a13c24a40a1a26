// How long a case takes at least.
#pragma once

#include "harness/vectors/case.hpp"
#include "src/base/time.hpp"

namespace fieldproof::run {

/// By its own steps: what it waits for, and the silences and periods that it sits out.
Duration least_length(const vectors::Case& source, Duration response_max);

}  // namespace fieldproof::run
