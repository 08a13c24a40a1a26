#include "harness/bench/fence.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <fmt/format.h>
#include <limits>
#include <optional>

namespace fieldproof {

namespace {

constexpr std::uint32_t whole_area = std::numeric_limits<std::uint32_t>::max();

struct Point {
  std::string area;
  std::uint32_t word = 0;
  bool whole = false;  // no number: the area
};

/// "M", "M100" or "%MW100".
std::optional<Point> read_point(std::string_view text) {
  if (text.starts_with('%')) {
    text.remove_prefix(1);
    if (text.size() < 2 || std::toupper(text[1]) != 'W') return std::nullopt;
    Point point{std::string(1, static_cast<char>(std::toupper(text[0]))), 0, text.size() == 2};
    text.remove_prefix(2);
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), point.word);
    if (!point.whole && (error != std::errc{} || end != text.data() + text.size())) return std::nullopt;
    return point;
  }
  if (text.empty() || !std::isalpha(static_cast<unsigned char>(text[0]))) return std::nullopt;
  Point point{std::string(1, static_cast<char>(std::toupper(text[0]))), 0, text.size() == 1};
  text.remove_prefix(1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), point.word);
  if (!point.whole && (error != std::errc{} || end != text.data() + text.size())) return std::nullopt;
  return point;
}

}  // namespace

Status WriteFence::allow(const std::string& ranges) {
  for (std::string_view rest = ranges; !rest.empty();) {
    const std::string_view part = rest.substr(0, rest.find(','));
    rest.remove_prefix(std::min(part.size() + 1, rest.size()));
    if (part == "all") {
      ranges_.push_back({"all", 0, whole_area});
      continue;
    }
    const std::size_t dash = part.find('-');
    const std::optional<Point> first = read_point(part.substr(0, dash));
    const std::optional<Point> last = dash == std::string_view::npos ? first : read_point(part.substr(dash + 1));
    if (!first || !last || first->area != last->area || first->whole != last->whole || last->word < first->word)
      return fail(fmt::format("cannot read --allow-write '{}'; write an area (M), words (M100-M199 or %MW100-%MW199), or all", part));
    ranges_.push_back({first->area, first->word, first->whole ? whole_area : last->word});
  }
  return ok();
}

bool WriteFence::allows(const Protocol::Written& written, std::string_view output_areas) const {
  const bool output = !written.area.empty() && output_areas.find(written.area) != std::string_view::npos;
  return std::ranges::any_of(ranges_, [&](const Range& range) {
    if (range.area == "all") return !output;
    return range.area == written.area && range.first <= written.first_word && written.last_word <= range.last;
  });
}

std::string WriteFence::objection(const std::vector<Protocol::Written>& written, std::string_view output_areas) const {
  for (const Protocol::Written& one : written) {
    if (allows(one, output_areas)) continue;
    if (one.area == "?") return "sends a damaged write request, whose target cannot be told; allow it with --allow-write all";
    const std::string words = one.first_word == one.last_word ? fmt::format("{}{}", one.area, one.first_word)
                                                              : fmt::format("{0}{1}-{0}{2}", one.area, one.first_word, one.last_word);
    return fmt::format("writes {}; allow it with --allow-write {}", one.address, words);
  }
  return {};
}

}  // namespace fieldproof
