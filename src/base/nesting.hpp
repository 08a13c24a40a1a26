// JSON that somebody else has written may nest as deep as it is long; whoever copies or prints it
// goes as deep.
#pragma once

#include <string_view>

namespace fieldproof {

/// No file or line of this project nests deeper.
inline constexpr int deepest_nesting = 100;

/// `json` as far as it is not nested deeper: what was cut is no JSON, and its reader says where.
std::string_view not_too_deep(std::string_view json);

}  // namespace fieldproof
