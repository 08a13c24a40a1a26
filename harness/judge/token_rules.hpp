// What never happens on a token bus, whatever a case is about: looked for in every run of a model
// of one (DECISIONS.md xnet/token-bus, xnet/token).
#pragma once

#include <string>

#include "src/base/trace.hpp"

namespace fieldproof::judging {

/// The first rule that the turns break, in words; empty: none. One station sends at a time, none
/// longer than it has the token, and each that is there has it once in a cycle.
std::string broken_token_rule(const NetTrace& net);

}  // namespace fieldproof::judging
