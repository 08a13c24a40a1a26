#include "src/plc/address.hpp"

#include <algorithm>
#include <array>

#include "src/base/bytes.hpp"
#include "src/base/letters.hpp"

namespace fieldproof::plc {

namespace {
constexpr std::uint32_t beyond = 1'000'000;  // more than any area holds

bool is_decimal(char c) { return c >= '0' && c <= '9'; }

struct Number {
  AddressFault fault = AddressFault::none;
  std::uint32_t value = 0;
};

/// A decimal number with any number of leading zeros. A hex letter is a number that the area cannot
/// hold (%MWFFFFF is 7132 in Appendix 3.1); any other character is no number at all.
Number read_number(std::string_view digits) {
  if (digits.empty()) return {AddressFault::form};
  Number number;
  for (const char c : digits) {
    if (hex_digit(c) < 0) return {AddressFault::form};
    if (!is_decimal(c)) {
      number.fault = AddressFault::range;
    } else if (number.value < beyond) {
      number.value = number.value * 10 + static_cast<std::uint32_t>(c - '0');
    }
  }
  return number;
}

/// Decimal word and one hex bit digit; one digit alone is a bit of word 0.
Number read_bit_name(std::string_view digits) {
  if (digits.empty()) return {AddressFault::form};
  const int bit = hex_digit(digits.back());
  if (bit < 0) return {AddressFault::form};
  const std::string_view word_digits = digits.substr(0, digits.size() - 1);
  if (word_digits.empty()) return {AddressFault::none, static_cast<std::uint32_t>(bit)};
  Number word = read_number(word_digits);
  word.value = std::min(word.value, beyond) * 16 + static_cast<std::uint32_t>(bit);
  return word;
}

std::uint32_t elements_in_words(std::uint32_t words, char type) {
  switch (type) {
    case 'X': return words * 16;
    case 'B': return words * 2;
    case 'W': return words;
    case 'D': return words / 2;
    default: return words / 4;
  }
}

/// "base.slot.element"
Number read_dotted(const DeviceArea& area, char type, std::string_view text) {
  if (!area.dotted) return {AddressFault::form};
  std::array<Number, 3> parts;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const std::size_t dot = text.find('.');
    if ((dot == std::string_view::npos) != (i == 2)) return {AddressFault::form};
    parts[i] = read_number(text.substr(0, dot));
    if (parts[i].fault == AddressFault::form) return parts[i];
    text.remove_prefix(i == 2 ? text.size() : dot + 1);
  }
  const std::uint32_t slot_elements = elements_in_words(area.dotted.slot_words, type);
  const std::array limits{area.dotted.bases, area.dotted.slots, slot_elements};
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (parts[i].fault != AddressFault::none || parts[i].value >= limits[i])
      return {AddressFault::range};
  }
  return {AddressFault::none,
          (parts[0].value * area.dotted.slots + parts[1].value) * slot_elements + parts[2].value};
}

Number read_index(const PlcModel& model, const DeviceArea& area, char type, std::string_view text) {
  if (text.find('.') != std::string_view::npos) return read_dotted(area, type, text);
  if (type == 'X' && !model.iec && area.contacts == 0) return read_bit_name(text);
  return read_number(text);
}
}  // namespace

std::uint32_t element_count(const DeviceArea& area, char type) {
  return type == 'X' && area.contacts != 0 ? area.contacts : elements_in_words(area.words, type);
}

ParsedAddress parse_address(const PlcModel& model, std::string_view name, bool bits_of_d) {
  ParsedAddress parsed;
  const auto failed = [&parsed](AddressFault fault) {
    parsed.fault = fault;
    return parsed;
  };
  if (name.empty() || name[0] != '%') return failed(AddressFault::percent);
  const DeviceArea* area = name.size() < 2 ? nullptr : model.area(upper(name[1]));
  if (!area) return failed(AddressFault::area);
  parsed.address.area = static_cast<std::uint8_t>(area - model.areas.data());
  const char type = name.size() < 3 ? '\0' : upper(name[2]);
  // Dwords and lwords of D are printed as examples, and accepted.
  if (type_bytes(type) == 0 || (type == 'X' && area->letter == 'D' && !bits_of_d))
    return failed(AddressFault::type);
  parsed.address.type = type;
  parsed.address.contact = type == 'X' && area->contacts != 0;
  const Number number = read_index(model, *area, type, name.substr(3));
  if (number.fault != AddressFault::none) return failed(number.fault);
  if (number.value >= element_count(*area, type)) return failed(AddressFault::range);
  parsed.address.index = number.value;
  return parsed;
}

bool fits(const PlcModel& model, const DeviceAddress& address, std::uint32_t count) {
  if (address.area >= model.areas.size() || type_bytes(address.type) == 0) return false;
  const std::uint32_t elements = element_count(model.areas[address.area], address.type);
  return address.index <= elements && count <= elements - address.index;
}

std::string_view describe(AddressFault fault) {
  switch (fault) {
    case AddressFault::none: return "it is right";
    case AddressFault::percent: return "it does not begin with %";
    case AddressFault::area: return "the model has no such area";
    case AddressFault::type: return "the type is not one that the area has (X, B, W, D, L)";
    case AddressFault::form: return "what follows the type is not a number";
    case AddressFault::range: return "it is beyond the area";
  }
  return "";
}

}  // namespace fieldproof::plc
