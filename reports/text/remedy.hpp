// What would let a case run that is BLOCKED.
#pragma once

#include <string>

namespace fieldproof::text {

/// In words, and with the option where there is one: "permission to write: --allow-write RANGES".
/// Reasons that the same thing ends have the same remedy; one that is not known is the reason
/// itself without its values.
std::string remedy_of(const std::string& reason);

}  // namespace fieldproof::text
