#include "src/plc/memory.hpp"

#include <fmt/format.h>

#include <stdexcept>
#include <vector>

#include "src/base/bytes.hpp"

namespace fieldproof::plc {

PlcMemory::PlcMemory(const PlcModel& model) : model_(&model) {
  std::uint32_t words = 0, contacts = 0;
  for (std::size_t i = 0; i < model.areas.size(); ++i) {
    first_word_.at(i) = words;
    first_contact_.at(i) = contacts;
    if (model.areas[i].same_as == 0) words += model.areas[i].words;
    contacts += model.areas[i].contacts;
  }
  for (std::size_t i = 0; i < model.areas.size(); ++i)
    if (const DeviceArea* same = model.area(model.areas[i].same_as))
      first_word_.at(i) = first_word_.at(static_cast<std::size_t>(same - model.areas.data()));
  words_ = Zeroed<std::uint16_t>(words);
  contacts_ = Zeroed<std::uint8_t>(contacts);
}

void PlcMemory::check(const DeviceAddress& address) const {
  if (!fits(*model_, address)) throw std::out_of_range("PlcMemory: address outside its area");
}

std::uint64_t PlcMemory::read(const DeviceAddress& address) const {
  check(address);
  const std::uint32_t index = address.index;
  const std::uint16_t* words = &words_[first_word_[address.area]];
  switch (address.type) {
    case 'X':
      if (address.contact) return contacts_[first_contact_[address.area] + index];
      return words[index / 16] >> (index % 16) & 1u;
    case 'B': return words[index / 2] >> (index % 2 * 8) & 0xFFu;
    case 'W': return words[index];
    case 'D': return static_cast<std::uint64_t>(words[index * 2 + 1]) << 16 | words[index * 2];
    default: break;
  }
  std::uint64_t value = 0;
  for (std::uint32_t i = 4; i-- > 0;) value = value << 16 | words[index * 4 + i];
  return value;
}

void PlcMemory::write(const DeviceAddress& address, std::uint64_t value) {
  check(address);
  const std::uint32_t index = address.index;
  std::uint16_t* words = &words_[first_word_[address.area]];
  const auto put = [](std::uint16_t& word, unsigned shift, unsigned mask, std::uint64_t bits) {
    word = static_cast<std::uint16_t>((word & ~(mask << shift)) |
                                      (static_cast<unsigned>(bits) & mask) << shift);
  };
  switch (address.type) {
    case 'X':
      if (address.contact)
        contacts_[first_contact_[address.area] + index] = value & 1u;
      else
        put(words[index / 16], index % 16, 1u, value);
      return;
    case 'B': put(words[index / 2], index % 2 * 8, 0xFFu, value); return;
    default: break;
  }
  const std::uint32_t size = type_bytes(address.type) / 2;
  for (std::uint32_t i = 0; i < size; ++i, value >>= 16)
    words[index * size + i] = static_cast<std::uint16_t>(value);
}

namespace {
struct Elements {
  DeviceAddress first;
  std::uint32_t count = 0;
  std::size_t digits = 0;  // each
};

/// What `digits` hex digits at a device address cover.
Result<Elements> find_elements(const PlcMemory& memory, std::string_view verb,
                               std::string_view name, std::size_t digits) {
  const ParsedAddress parsed = parse_address(memory.model(), name);
  if (!parsed)
    return fail(fmt::format("cannot {} {} on {}: {}", verb, name, memory.model().name,
                            describe(parsed.fault)));
  Elements elements{parsed.address, 1, type_bytes(parsed.address.type) * std::size_t{2}};
  if (digits == 0) return elements;
  if (digits % elements.digits != 0) {
    return fail(fmt::format(
        "cannot {} {}: {} digits are not a whole number of elements; give {} digits for each", verb,
        name, digits, elements.digits));
  }
  elements.count = static_cast<std::uint32_t>(digits / elements.digits);
  if (!fits(memory.model(), elements.first, elements.count)) {
    return fail(fmt::format("cannot {} {} elements from {} on: the area ends before", verb,
                            elements.count, name));
  }
  return elements;
}
}  // namespace

Status set_by_name(PlcMemory& memory, std::string_view address, std::string_view hex) {
  if (hex.empty())
    return fail(fmt::format("cannot set {}: there is no value; give its hex digits", address));
  const Result<Elements> elements = find_elements(memory, "set", address, hex.size());
  if (!elements) return elements.error();
  std::vector<std::uint64_t> values;
  for (std::size_t at = 0; at < hex.size(); at += elements->digits) {
    std::uint64_t value = 0;
    for (const char c : hex.substr(at, elements->digits)) {
      if (hex_digit(c) < 0)
        return fail(fmt::format("cannot set {} to {}: '{}' is not a hex digit", address, hex, c));
      value = value << 4 | static_cast<std::uint64_t>(hex_digit(c));
    }
    if (elements->first.type == 'X' && value > 1) {
      return fail(fmt::format("cannot set {} to {}: a bit is 00 or 01", address, hex));
    }
    values.push_back(value);
  }
  for (std::uint32_t i = 0; i < values.size(); ++i) memory.write(elements->first + i, values[i]);
  memory.written();
  return ok();
}

Result<std::string> get_by_name(const PlcMemory& memory, std::string_view address,
                                std::size_t digits) {
  const Result<Elements> elements = find_elements(memory, "get", address, digits);
  if (!elements) return elements.error();
  std::string hex;
  for (std::uint32_t i = 0; i < elements->count; ++i) {
    hex += hex_number(memory.read(elements->first + i), static_cast<int>(elements->digits));
  }
  return hex;
}

}  // namespace fieldproof::plc
