#include "harness/vectors/filter.hpp"

#include <algorithm>
#include <set>

#include "src/base/spelling.hpp"

namespace fieldproof::vectors {

namespace {

/// `more`: the text may go on in any way.
bool glob(std::string_view text, std::string_view pattern, bool more) {
  std::size_t at = 0, in_text = 0;
  std::size_t star = pattern.npos;  // the last one
  std::size_t after_star = 0;       // the text behind what it took
  while (in_text < text.size()) {
    if (at < pattern.size() && pattern[at] == '*') {
      star = at++;
      after_star = in_text;
    } else if (at < pattern.size() && (pattern[at] == '?' || pattern[at] == text[in_text])) {
      ++at;
      ++in_text;
    } else if (star != pattern.npos) {
      at = star + 1;
      in_text = ++after_star;
    } else {
      return false;
    }
  }
  return more || pattern.find_first_not_of('*', at) == pattern.npos;
}

/// The next of the patterns between ':'.
std::string_view take_part(std::string_view& filter) {
  const std::string_view part = filter.substr(0, filter.find(':'));
  filter.remove_prefix(std::min(part.size() + 1, filter.size()));
  return part;
}

/// The first `parts` parts of an id between slashes; all of it where it has fewer.
std::string_view first_parts(std::string_view id, std::ptrdiff_t parts) {
  std::size_t end = 0;
  for (; parts > 0 && end != id.npos; --parts) end = id.find('/', end ? end + 1 : 0);
  return id.substr(0, end);
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

std::string folders_of_filter(std::string_view filter) {
  std::string folders;
  if (filter.starts_with('-')) return folders;
  while (!filter.empty()) {
    const std::string_view part = take_part(filter);
    if (part.starts_with('-')) continue;
    const std::string_view folder = part.substr(0, part.find('/'));
    if (folder.size() == part.size() || folder.find_first_of("*?") != folder.npos) return {};
    folders.append(folders.empty() ? "" : ":").append(folder).append("/*");
  }
  return folders;
}

std::string meant_filter(std::string_view filter, const std::vector<std::string>& ids) {
  while (!filter.empty()) {
    const std::string_view part = take_part(filter);
    const auto selects = [&](const std::string& id) { return glob(id, part, false); };
    if (part.starts_with('-') || std::ranges::any_of(ids, selects)) continue;
    std::string_view head = part.substr(0, part.find_first_of("*?"));
    while (head.ends_with('/')) head.remove_suffix(1);
    const std::ptrdiff_t parts = std::ranges::count(head, '/') + 1;
    std::set<std::string_view> beginnings;
    for (const std::string& id : ids) beginnings.insert(first_parts(id, parts));
    if (beginnings.contains(head)) return fmt::format("; did you mean '{}/*'?", head);
    return suggestion(head, std::vector<std::string_view>(beginnings.begin(), beginnings.end()));
  }
  return {};
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
