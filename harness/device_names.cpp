#include "harness/device_names.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cctype>
#include <charconv>

#include "src/base/letters.hpp"

namespace fieldproof::harness {

namespace {

/// Elements in so many words; nothing where it is no whole number of them.
std::optional<std::int64_t> elements_in(const plc::DeviceAddress& address, int words) {
  if (address.contact) return words;
  switch (address.type) {
    case 'X': return std::int64_t{words} * 16;
    case 'B': return std::int64_t{words} * 2;
    case 'W': return words;
    default: break;
  }
  const int width = static_cast<int>(plc::type_bytes(address.type) / 2);
  if (words % width != 0) return std::nullopt;
  return words / width;
}

/// The decimal number `text` plus `step`; in no fewer digits.
std::optional<std::string> add_to(std::string_view text, std::int64_t step, Digits digits) {
  std::int64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || end != text.data() + text.size() || number + step < 0)
    return std::nullopt;
  std::string sum = fmt::format("{:0{}}", number + step, text.size());
  if (digits == Digits::as_many && sum.size() != text.size()) return std::nullopt;
  return sum;
}

std::optional<std::uint32_t> read_number(std::string_view text) {
  std::uint32_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// First word that `count` elements from a name could touch, and the last.
struct Words {
  std::uint32_t first = 0, last = 0;
};

std::optional<Words> words_at(const ElementName& name, std::uint32_t count) {
  if (name.type == 'X') {
    // Decimal word and one hex bit digit, or flat bit index: either may be meant.
    const std::optional<std::uint32_t> word =
        name.number.size() > 1 ? read_number(name.number.substr(0, name.number.size() - 1)) : 0;
    const std::optional<std::uint32_t> flat = read_number(name.number);
    if (!word) return std::nullopt;
    const std::uint32_t other = flat ? *flat / 16 : *word;
    return Words{std::min(*word, other), std::max(*word, other)};
  }
  const std::optional<std::uint32_t> index = read_number(name.number);
  if (!index || count == 0) return std::nullopt;
  const auto bytes = static_cast<std::uint32_t>(name.element_bytes());
  return Words{*index * bytes / 2, ((*index + count) * bytes - 1) / 2};
}

}  // namespace

std::optional<ElementName> read_element_name(std::string_view text) {
  if (text.size() < 4 || text[0] != '%') return std::nullopt;
  const ElementName name{upper(text[1]), upper(text[2]), text.substr(3)};
  if (plc::type_bytes(name.type) == 0) return std::nullopt;
  return name;
}

bool is_bit_name(std::string_view text) {
  return text.size() > 3 && text[0] == '%' && upper(text[2]) == 'X';
}

Result<std::string> element_further_on(const ElementName& name, std::size_t elements) {
  const std::optional<std::uint32_t> index = read_number(name.number);
  if (!index)
    return fail(fmt::format("cannot count on from %{}{}{}", name.area, name.type, name.number));
  return fmt::format("%{}{}{}", name.area, name.type, *index + elements);
}

Protocol::Written memory_at(const plc::PlcModel* model, const std::string& address,
                            std::uint32_t count) {
  if (model && count > 0)
    if (const plc::ParsedAddress parsed = plc::parse_address(*model, address))
      return memory_of(*model, parsed.address, count, address);
  const std::optional<ElementName> name = read_element_name(address);
  const std::optional<Words> words = name ? words_at(*name, count) : std::nullopt;
  if (!words)
    return {name ? std::string(1, name->area) : "?", 0, ~0u,
            address};  // dotted or damaged: the whole area
  return {std::string(1, name->area), words->first, words->last, address};
}

Protocol::Written memory_of(const plc::PlcModel& model, const plc::DeviceAddress& address,
                            std::uint32_t count, std::string_view name) {
  const std::string area(1, model.areas[address.area].letter);
  const std::uint32_t last = address.index + std::max(count, 1u) - 1;
  if (address.contact) return {area, address.index, last, std::string(name), true};
  if (address.type == 'X') return {area, address.index / 16, last / 16, std::string(name)};
  const std::uint32_t bytes = plc::type_bytes(address.type);
  return {area, address.index * bytes / 2, ((last + 1) * bytes - 1) / 2, std::string(name)};
}

std::optional<Protocol::WordName> read_word_name(std::string_view text) {
  const bool full = text.starts_with('%');
  if (full && (text.size() < 3 || std::toupper(text[2]) != 'W')) return std::nullopt;
  if (full) text.remove_prefix(1);
  if (text.empty()) return std::nullopt;
  const char area = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  if (plc::last_words_of(area).empty()) return std::nullopt;
  text.remove_prefix(full ? 2 : 1);
  Protocol::WordName name{std::string(1, area), {}};
  if (text.empty()) return full ? std::nullopt : std::optional(name);
  const auto [end, error] =
      std::from_chars(text.data(), text.data() + text.size(), name.word.emplace());
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return name;
}

std::optional<Protocol::Written> named_memory(const plc::PlcModel& model, std::string_view name,
                                              std::size_t digits) {
  const plc::ParsedAddress parsed = plc::parse_address(model, name);
  if (!parsed) return std::nullopt;
  const auto count =
      static_cast<std::uint32_t>(digits / (2 * plc::type_bytes(parsed.address.type)));
  return memory_of(model, parsed.address, count, name);
}

std::optional<std::string> moved_name(const plc::PlcModel& model, std::string_view name, int words,
                                      Digits digits) {
  const plc::ParsedAddress parsed = plc::parse_address(model, name);
  if (!parsed || name.find('.') != std::string_view::npos) return std::nullopt;
  // XBM and XBC: decimal word and one hex digit for the bit.
  const bool word_and_bit = parsed.address.type == 'X' && !parsed.address.contact && !model.iec;
  const std::size_t tail = word_and_bit ? 1 : 0;
  const std::string_view number = name.substr(3, name.size() - 3 - tail);
  const std::optional<std::int64_t> step =
      word_and_bit ? words : elements_in(parsed.address, words);
  const std::optional<std::string> sum = step ? add_to(number, *step, digits) : std::nullopt;
  if (!sum) return std::nullopt;
  std::string moved =
      std::string(name.substr(0, 3)) + *sum + std::string(name.substr(name.size() - tail));
  if (!plc::parse_address(model, moved)) return std::nullopt;
  return moved;
}

std::vector<Protocol::Place> places_on(const plc::PlcModel& model,
                                       const Protocol::Written& written) {
  const plc::DeviceArea* area = written.area.size() == 1 ? model.area(written.area[0]) : nullptr;
  if (area && !area->write) return {};
  std::vector<Protocol::Place> places;
  if (written.contacts) {
    for (std::uint32_t contact = written.first_word; contact <= written.last_word; ++contact)
      places.push_back(
          {fmt::format("%{}X{}", written.area, contact), 2, area && contact < area->contacts});
    return places;
  }
  const std::uint32_t has = area ? area->words : 0;
  const auto add = [&](std::uint32_t first, std::uint32_t end, bool declared) {
    if (first < end)
      places.push_back(
          {fmt::format("%{}W{}", written.area, first), (end - first) * std::size_t{4}, declared});
  };
  add(written.first_word, std::min(written.last_word + 1, has), true);
  add(std::max(written.first_word, has), written.last_word + 1, false);
  return places;
}

}  // namespace fieldproof::harness
