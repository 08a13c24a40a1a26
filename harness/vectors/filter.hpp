// Globs that select cases by id.
#pragma once

#include <string_view>

namespace fieldproof::vectors {

/// "*" and "?" as in a shell; '*' crosses '/'. Alternatives are separated by ':' and a leading '-'
/// excludes.
bool matches_filter(std::string_view id, std::string_view filter);

/// Could an id that begins with `stem` match? May say yes in vain, never no in vain.
bool may_match_filter(std::string_view stem, std::string_view filter);

}  // namespace fieldproof::vectors
