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

/// Of "B:" in "B:1".
std::size_t plc_length(std::string_view axis) {
  const std::size_t colon = axis.find(':');
  return colon == axis.npos ? 0 : colon + 1;
}

/// 0: it is none.
std::uint32_t axis_number(std::string_view text) {
  std::uint32_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() ? value : 0;
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

Status WriteFence::allow_motion(const std::string& axes, unsigned last) {
  for (const std::string_view part : parts_of(axes)) {
    const auto wrong = [&](const std::string& why) {
      return fail(fmt::format("cannot read --allow-motion '{}': {}", part, why));
    };
    if (part == "all") {
      axes_.push_back({"all", 1, whole_area});
      continue;
    }
    const std::size_t plc = plc_length(part);
    const std::string_view range = part.substr(plc);
    Axes named{std::string(part.substr(0, plc)), 1, whole_area};
    if (range != "all") {
      const std::size_t dash = range.find('-');
      named.first = axis_number(range.substr(0, dash));
      named.last = dash == range.npos ? named.first : axis_number(range.substr(dash + 1));
      if (named.first == 0 || named.last < named.first)
        return wrong("write an axis (1), axes (3-5), one of PLC B (B:1), or all");
      if (named.last > last) return wrong(fmt::format("axes are 1 to {}", last));
    }
    axes_.push_back(std::move(named));
  }
  return ok();
}

std::string WriteFence::motion_objection(std::string_view axis, std::string_view by) const {
  if (axis.empty()) return {};
  const std::string_view of = axis.substr(0, plc_length(axis));
  const std::uint32_t number = axis_number(axis.substr(of.size()));
  const bool known = number != 0;
  const bool allowed = std::ranges::any_of(axes_, [&](const Axes& one) {
    const bool in = known ? one.first <= number && number <= one.last : one.last == whole_area;
    return in && (one.of == "all" || one.of == of);
  });
  if (allowed) return {};
  return fmt::format("moves {} ({}); allow it with --allow-motion {}, when nobody stands near",
                     known ? fmt::format("axis {}", axis) : "an axis", by,
                     known ? std::string(axis) : fmt::format("{}all", of));
}

std::string WriteFence::motion_objection(const std::vector<harness::Protocol::Written>& written,
                                         const harness::Protocol& protocol) const {
  if (protocol.last_axis() == 0) return {};
  for (const harness::Protocol::Written& one : written) {
    if (one.unknown()) {
      if (std::string why = motion_objection("?", "writes " + one.address); !why.empty())
        return why;
      continue;
    }
    for (std::uint32_t word = one.first_word; word <= one.last_word; ++word) {
      const std::string name = protocol.spell(one.area, word);
      if (std::string why = motion_objection(protocol.moved_by(name), "writes " + name);
          !why.empty())
        return why;
    }
  }
  return {};
}

bool WriteFence::allows(const harness::Protocol::Written& written,
                        const std::vector<std::string_view>& output_areas) const {
  if (written.area == "?")
    return std::ranges::any_of(ranges_, [](const Range& range) {
      return range.area == "all" || range.area == everything;
    });
  return std::ranges::any_of(allowed(written.area, output_areas), [&](const Words& words) {
    return words.first <= written.first_word && written.last_word <= words.last;
  });
}

std::vector<WriteFence::Words> WriteFence::allowed(
    std::string_view area, const std::vector<std::string_view>& output_areas) const {
  const bool output = std::ranges::count(output_areas, area) > 0;
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
