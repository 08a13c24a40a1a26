#include "harness/safety/fence.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <charconv>
#include <limits>
#include <optional>

namespace fieldproof::safety {

namespace {

constexpr std::uint32_t whole_area = std::numeric_limits<std::uint32_t>::max();

/// What stands between commas.
std::vector<std::string_view> parts_of(std::string_view list) {
  std::vector<std::string_view> parts;
  while (!list.empty()) {
    parts.push_back(list.substr(0, list.find(',')));
    list.remove_prefix(std::min(parts.back().size() + 1, list.size()));
  }
  return parts;
}

}  // namespace

Status WriteFence::allow(const std::string& ranges, const WordReader& words) {
  for (const std::string_view part : parts_of(ranges)) {
    if (part == "all") {
      ranges_.push_back({"all", 0, whole_area});
      continue;
    }
    const std::size_t dash = part.find('-');
    const auto first = words(part.substr(0, dash));
    const auto last = dash == std::string_view::npos ? first : words(part.substr(dash + 1));
    if (!first || !last || first->area != last->area || !first->word != !last->word ||
        last->word < first->word)
      return fail(
          fmt::format("cannot read --allow-write '{}': no protocol has such memory; write an area, "
                      "a word, a range of words (FIRST-LAST), or all",
                      part));
    ranges_.push_back({first->area, first->word.value_or(0), last->word.value_or(whole_area)});
  }
  return ok();
}

Status WriteFence::allow_motion(const std::string& axes) {
  const auto number = [](std::string_view text) {
    std::uint32_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size() ? value : 0;
  };
  for (const std::string_view part : parts_of(axes)) {
    const std::size_t dash = part.find('-');
    const std::uint32_t first = part == "all" ? 1 : number(part.substr(0, dash));
    const std::uint32_t last = part == "all"                    ? whole_area
                               : dash == std::string_view::npos ? first
                                                                : number(part.substr(dash + 1));
    if (first == 0 || last < first)
      return fail(fmt::format(
          "cannot read --allow-motion '{}': write an axis (1), axes (3-5), or all", part));
    axes_.push_back({first, last});
  }
  return ok();
}

std::string WriteFence::motion_objection(std::string_view axis, std::string_view by) const {
  if (axis.empty()) return {};
  std::uint32_t number = whole_area;
  std::from_chars(axis.data(), axis.data() + axis.size(), number);
  if (std::ranges::any_of(
          axes_, [&](const Words& one) { return one.first <= number && number <= one.last; }))
    return {};
  const bool known = number != whole_area;
  return fmt::format("moves {} ({}); allow it with --allow-motion {}, when nobody stands near",
                     known ? fmt::format("axis {}", axis) : "an axis", by, known ? axis : "all");
}

bool WriteFence::allows(const harness::Protocol::Written& written,
                        std::string_view output_areas) const {
  if (written.area == "?")
    return std::ranges::any_of(ranges_, [](const Range& range) {
      return range.area == "all" || range.area == everything;
    });
  return std::ranges::any_of(allowed(written.area, output_areas), [&](const Words& words) {
    return words.first <= written.first_word && written.last_word <= words.last;
  });
}

std::vector<WriteFence::Words> WriteFence::allowed(std::string_view area,
                                                   std::string_view output_areas) const {
  const bool output = output_areas.find(area) != std::string_view::npos;
  std::vector<Words> found;
  for (const Range& range : ranges_)
    if (range.area == everything || (range.area == "all" ? !output : range.area == area))
      found.push_back({range.first, range.last});
  std::ranges::sort(found, {}, &Words::first);
  std::vector<Words> joined;
  for (const Words& one : found) {
    const bool meets = !joined.empty() &&
                       (joined.back().last == whole_area || one.first <= joined.back().last + 1);
    if (meets)
      joined.back().last = std::max(joined.back().last, one.last);
    else
      joined.push_back(one);
  }
  return joined;
}

std::string WriteFence::objection(const std::vector<harness::Protocol::Written>& written,
                                  const harness::Protocol& protocol) const {
  for (const harness::Protocol::Written& one : written) {
    if (allows(one, protocol.output_areas())) continue;
    if (one.area == "?")
      return "sends a damaged write request, whose target cannot be told; allow it with "
             "--allow-write all";
    const std::string first = protocol.spell(one.area, one.first_word),
                      last = protocol.spell(one.area, one.last_word);
    const std::string words = one.unknown() ? one.area : first == last ? first : first + "-" + last;
    return fmt::format("writes {}; allow it with --allow-write {}", one.address, words);
  }
  return {};
}

}  // namespace fieldproof::safety
