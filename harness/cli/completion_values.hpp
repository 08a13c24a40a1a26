// What may stand behind an option, for completion.
#pragma once

#include "harness/protocols.hpp"
#include "harness/usage/completion.hpp"

namespace fieldproof::cli {

/// Ids of cases (up to their next slash, for filters of several globs, too), profiles, protocols,
/// kinds of endpoint, models. None for files, which the shell knows.
usage::Values completion_values(const harness::Protocols& protocols);

}  // namespace fieldproof::cli
