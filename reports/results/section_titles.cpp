#include "reports/results/section_titles.hpp"

#include <algorithm>

namespace fieldproof::results {
namespace {

constexpr std::string_view digits = "0123456789";

bool is_digit(char c) { return digits.find(c) != std::string_view::npos; }

/// Where the number ends: "7.1.5" of "7.1.5 (1)", "Appendix 3.1" of "Appendix 3.1 (2)".
std::size_t end_of_number(std::string_view section) {
  const std::size_t first = section.find_first_of(digits);
  return std::min(section.find_first_of(" (", first), section.size());
}

}  // namespace

bool is_within(std::string_view section, std::string_view number) {
  if (!section.starts_with(number)) return false;
  return section.size() == number.size() || !is_digit(section[number.size()]);
}

std::string_view title_of(const SectionTitles& titles, std::string_view section) {
  const std::size_t least = end_of_number(section);
  for (std::size_t end = section.size(); end >= least && end > 0; --end) {
    const auto found = titles.find(std::string(section.substr(0, end)));
    if (found != titles.end() && is_within(section, found->first)) return found->second;
  }
  return {};
}

std::string part_of(std::string_view section) {
  const std::string_view number = section.substr(0, end_of_number(section));
  if (!is_numbered(number)) return std::string(section);
  const bool is_appendix = number.find(' ') != std::string_view::npos;
  std::size_t end = number.find_first_of(".-");
  if (!is_appendix && end < number.size()) end = number.find_first_of(".-", end + 1);
  return std::string(number.substr(0, end));
}

bool is_numbered(std::string_view section) {
  const std::size_t first = section.find_first_of(digits);
  return first == 0 || (first < section.size() && section.find_first_of(" .") == first - 1);
}

}  // namespace fieldproof::results
