#include "harness/safety/fence.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cctype>
#include <charconv>
#include <limits>
#include <optional>

namespace fieldproof::safety {

namespace {

constexpr std::uint32_t whole_area = std::numeric_limits<std::uint32_t>::max();

struct Point {
  std::string area;
  std::uint32_t word = 0;
  bool whole = false;  // no number: the area
};

bool read_number(std::string_view digits, int base, std::uint32_t& number) {
  const auto [end, error] =
      std::from_chars(digits.data(), digits.data() + digits.size(), number, base);
  return error == std::errc{} && end == digits.data() + digits.size();
}

/// "M", "M100", "%MW100"; "h1230" or "1230": the words of area H are addressed in hex.
std::optional<Point> read_point(std::string_view text) {
  const bool bare_hex = text.size() == 4 && std::isdigit(static_cast<unsigned char>(text[0]));
  const bool percent = text.starts_with('%');
  if (percent) text.remove_prefix(1);
  if (percent && (text.size() < 2 || std::toupper(text[1]) != 'W')) return std::nullopt;
  if (!bare_hex && (text.empty() || !std::isalpha(static_cast<unsigned char>(text[0]))))
    return std::nullopt;
  const char area = bare_hex ? 'H' : static_cast<char>(std::toupper(text[0]));
  text.remove_prefix(bare_hex ? 0 : percent ? 2 : 1);
  Point point{std::string(1, area), 0, text.empty()};
  if (!point.whole && !read_number(text, area == 'H' ? 16 : 10, point.word)) return std::nullopt;
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
    const std::optional<Point> last =
        dash == std::string_view::npos ? first : read_point(part.substr(dash + 1));
    if (!first || !last || first->area != last->area || first->whole != last->whole ||
        last->word < first->word)
      return fail(
          fmt::format("cannot read --allow-write '{}'; write an area (M), words (M100-M199 or "
                      "%MW100-%MW199), parameters (h1230-h12FF), or all",
                      part));
    ranges_.push_back({first->area, first->word, first->whole ? whole_area : last->word});
  }
  return ok();
}

bool WriteFence::allows(const harness::Protocol::Written& written,
                        std::string_view output_areas) const {
  if (written.area == "?")
    return std::ranges::any_of(ranges_, [](const Range& range) { return range.area == "all"; });
  return std::ranges::any_of(allowed(written.area, output_areas), [&](const Words& words) {
    return words.first <= written.first_word && written.last_word <= words.last;
  });
}

std::vector<WriteFence::Words> WriteFence::allowed(std::string_view area,
                                                   std::string_view output_areas) const {
  const bool output = output_areas.find(area) != std::string_view::npos;
  std::vector<Words> found;
  for (const Range& range : ranges_)
    if (range.area == "all" ? !output : range.area == area)
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
