#include "harness/vectors/filter.hpp"

#include <algorithm>

namespace fieldproof::vectors {

namespace {

/// `more`: the text may go on in any way.
bool glob(std::string_view text, std::string_view pattern, bool more) {
  if (text.empty() && more) return true;
  if (pattern.empty()) return text.empty();
  if (pattern[0] == '*')
    return glob(text, pattern.substr(1), more) ||
           (!text.empty() && glob(text.substr(1), pattern, more));
  return !text.empty() && (pattern[0] == '?' || pattern[0] == text[0]) &&
         glob(text.substr(1), pattern.substr(1), more);
}

/// The next of the patterns between ':'.
std::string_view take_part(std::string_view& filter) {
  const std::string_view part = filter.substr(0, filter.find(':'));
  filter.remove_prefix(std::min(part.size() + 1, filter.size()));
  return part;
}

}  // namespace

bool matches_filter(std::string_view id, std::string_view filter) {
  bool selected = filter.empty() || filter.starts_with('-');
  while (!filter.empty()) {
    const std::string_view part = take_part(filter);
    if (part.starts_with('-') ? glob(id, part.substr(1), false) : glob(id, part, false))
      selected = !part.starts_with('-');
  }
  return selected;
}

bool may_match_filter(std::string_view stem, std::string_view filter) {
  if (filter.empty() || filter.starts_with('-')) return true;
  while (!filter.empty())
    if (const std::string_view part = take_part(filter);
        !part.starts_with('-') && glob(stem, part, true))
      return true;
  return false;
}

}  // namespace fieldproof::vectors
