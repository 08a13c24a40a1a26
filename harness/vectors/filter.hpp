// Globs that select cases by id.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace fieldproof::vectors {

/// "*" and "?" as in a shell; '*' crosses '/'. Alternatives are separated by ':' and a leading '-'
/// excludes.
bool matches_filter(std::string_view id, std::string_view filter);

/// Could an id that begins with `stem` match? May say yes in vain, never no in vain.
bool may_match_filter(std::string_view stem, std::string_view filter);

/// "xgt_cnet/*:ls_bus/*": all of the folders in which ids that match can be; empty: in any.
std::string folders_of_filter(std::string_view filter);

/// "; did you mean 'xgt_cnet/rss'?" for the first of its patterns that selects none of `ids`: what
/// stands before its first wildcard against beginnings of ids. Empty when none is close.
std::string meant_filter(std::string_view filter, const std::vector<std::string>& ids);

}  // namespace fieldproof::vectors
