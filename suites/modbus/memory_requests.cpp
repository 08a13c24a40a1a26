#include "suites/modbus/memory_requests.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <optional>

#include "harness/notation/notation.hpp"
#include "src/plc/address.hpp"
#include "suites/modbus/functions.hpp"

namespace fieldproof::modbus {

namespace {

constexpr std::size_t words_at_once = 59;
constexpr std::size_t bytes_at_once = 2 * words_at_once;
constexpr std::string_view write_area = "M";     // the default bases (PROTOCOLS.md)
constexpr std::string_view read_areas = "PI";

/// Where a device address lies in the data addresses of the default bases.
struct Place {
  bool bits = false;
  bool writable = false;
  char type = 0;
  std::uint32_t address = 0;  // data address of the first element
  std::uint32_t width = 0;    // data addresses an element: bits or words
};

/// The first model that has the address tells what it means.
std::optional<DeviceAddress> find_address(std::string_view name, char& area, AddressFault& fault) {
  for (const PlcModel& model : plc_models()) {
    const ParsedAddress parsed = parse_address(model, name);
    if (parsed) {
      area = model.areas[parsed.address.area].letter;
      return parsed.address;
    }
    fault = std::max(fault, parsed.fault);  // the model that came farthest says what is wrong
  }
  return std::nullopt;
}

Result<Place> place_of(std::string_view name) {
  if (name.starts_with('@')) return fail(fmt::format("{} is a counter, which no function code reaches", name));
  char area = 0;
  AddressFault fault = AddressFault::none;
  const std::optional<DeviceAddress> address = find_address(name, area, fault);
  if (!address) return fail(fmt::format("cannot reach {}: {}", name, describe(fault)));
  const bool writable = write_area.find(area) != std::string_view::npos;
  if (!writable && read_areas.find(area) == std::string_view::npos)
    return fail(fmt::format("{} lies outside the default bases, which are P (XEC: I) and M", name));
  const bool bits = address->type == 'X' || address->type == 'B';
  const std::uint32_t width = address->type == 'X' ? 1 : address->type == 'B' ? 8 : type_bytes(address->type) / 2;
  return Place{bits, writable, address->type, address->index * width, width};
}

struct Slice {
  std::uint32_t address = 0;
  std::uint32_t count = 0;   // bits or words
  std::size_t digit = 0;     // of the first element
  std::size_t digits = 0;
};

/// Cuts `digits` of memory into parts of one request each, of at most `most` elements.
Result<std::vector<Slice>> parts_of(const Place& place, std::string_view name, std::size_t digits, std::size_t most) {
  const std::size_t element = type_bytes(place.type) * 2;
  if (digits == 0 || digits % element != 0)
    return fail(fmt::format("{} digits are not a whole number of elements of {} ({} digits each)", digits, name, element));
  const std::size_t elements = digits / element;
  if (const std::size_t last = place.address + elements * place.width - 1; last > last_data_address)
    return fail(fmt::format("{} lies past data address {}, the last one", name, last_data_address));
  std::vector<Slice> parts;
  for (std::size_t done = 0; done < elements; done += most) {
    const std::size_t count = std::min(most, elements - done);
    parts.push_back({static_cast<std::uint32_t>(place.address + done * place.width), static_cast<std::uint32_t>(count * place.width),
                     done * element, count * element});
  }
  return parts;
}

void put_word(Bytes& message, std::size_t value) {
  message.push_back(static_cast<Byte>(value >> 8));
  message.push_back(static_cast<Byte>(value));
}

Bytes message_of(int station, Byte function, std::uint32_t address, std::uint32_t count) {
  Bytes message{static_cast<Byte>(station), function};
  put_word(message, address);
  put_word(message, count);
  return message;
}

/// A bit for each pair of digits, the first in bit 0 of the first byte.
Bytes packed_bits(const Bytes& values) {
  Bytes bytes((values.size() + 7) / 8);
  for (std::size_t i = 0; i < values.size(); ++i) bytes[i / 8] |= static_cast<Byte>((values[i] & 1) << (i % 8));
  return bytes;
}

/// Words in the order of their addresses; an element of several stands most significant first, in words of `width`.
Bytes words_in_order(const Bytes& values, std::uint32_t width) {
  Bytes bytes;
  for (std::size_t element = 0; element < values.size(); element += width * 2)
    for (std::size_t word = width; word-- > 0;) {
      bytes.push_back(values[element + word * 2]);
      bytes.push_back(values[element + word * 2 + 1]);
    }
  return bytes;
}

std::optional<std::string> refusal(ByteView message, ByteView reply) {
  if (reply.empty()) return "no answer";
  if (message.size() < 2) return "the answer is no frame: " + print_bytes(reply);
  if (!(message[1] & exception_bit)) return std::nullopt;
  const Byte code = message.size() > 2 ? message[2] : Byte{};
  return fmt::format("the device answers exception {:02X} {}", code, exception_meaning(code));
}

unsigned word_at(ByteView bytes, std::size_t at) { return bytes[at] * 256u + bytes[at + 1]; }

/// Functions of the Modbus standard that write and that the manual does not have: a file, a mask, read and write.
bool writes_elsewhere(Byte function) { return function >= 0x15 && function <= 0x17; }

Protocol::Written written(bool bits, std::uint32_t first, std::uint32_t count) {
  const std::uint32_t unit = bits ? 16 : 1;
  const std::uint32_t last = first + std::max(count, 1u) - 1;
  return {std::string(write_area), first / unit, last / unit, fmt::format("%{}W{}", write_area, first / unit)};
}

}  // namespace

Result<std::vector<Bytes>> write_requests(const Framing& framing, int station, std::string_view address, std::string_view hex) {
  const Result<Place> place = place_of(address);
  if (!place) return place.error();
  if (!place->writable) return fail(fmt::format("{} is read only with the default bases (function codes 02 and 04)", address));
  const std::size_t most = place->type == 'X' ? bytes_at_once * 8 : bytes_at_once / type_bytes(place->type);
  const Result<std::vector<Slice>> parts = parts_of(*place, address, hex.size(), most);
  if (!parts) return parts.error();
  std::vector<Bytes> requests;
  for (const Slice& part : *parts) {
    const std::optional<Bytes> values = from_hex(hex.substr(part.digit, part.digits));
    if (!values) return fail(fmt::format("'{}' is not hex", hex));
    const Bytes data = place->type == 'X' ? packed_bits(*values) : place->bits ? *values : words_in_order(*values, place->width);
    Bytes message = message_of(station, place->bits ? 0x0F : 0x10, part.address, part.count);
    message.push_back(static_cast<Byte>(data.size()));
    message.insert(message.end(), data.begin(), data.end());
    requests.push_back(framing.wrap(message));
  }
  return requests;
}

Result<std::vector<Bytes>> read_requests(const Framing& framing, int station, std::string_view address, std::size_t digits) {
  const Result<Place> place = place_of(address);
  if (!place) return place.error();
  const bool as_it_stands = place->type == 'B' || place->type == 'W';  // else one element a request
  const Result<std::vector<Slice>> parts = parts_of(*place, address, digits, as_it_stands ? bytes_at_once / type_bytes(place->type) : 1);
  if (!parts) return parts.error();
  const Byte function = place->bits ? (place->writable ? 0x01 : 0x02) : place->writable ? 0x03 : 0x04;
  std::vector<Bytes> requests;
  for (const Slice& part : *parts) {
    if (place->width <= 1 || place->bits) {
      requests.push_back(framing.wrap(message_of(station, function, part.address, part.count)));
      continue;
    }
    for (std::uint32_t word = part.count; word-- > 0;)  // the most significant word first
      requests.push_back(framing.wrap(message_of(station, function, part.address + word, 1)));
  }
  return requests;
}

Status write_reply(const Framing& framing, ByteView reply) {
  if (const std::optional<std::string> why = refusal(framing.unwrap(reply), reply)) return fail(*why);
  return ok();
}

Result<std::string> read_reply(const Framing& framing, ByteView reply) {
  const Bytes message = framing.unwrap(reply);
  if (const std::optional<std::string> why = refusal(message, reply)) return fail(*why);
  std::string digits;
  for (std::size_t i = 3; i < message.size(); ++i) digits += hex_number(message[i], 2);
  if (digits.empty()) return fail("the answer holds no data");
  return digits;
}

std::vector<Protocol::Written> written_by(const Framing& framing, ByteView request) {
  std::vector<Protocol::Written> result;
  for (const Bytes& message : framing.messages(request)) {
    if (message.size() < 2) continue;
    const FunctionCode* known = find_function(message[1]);
    const bool writes = known ? known->write : writes_elsewhere(message[1]);
    if (!writes) continue;
    const bool placed = known && message.size() >= (known->many ? 6u : 4u);
    if (!placed) {
      result.push_back({"?", 0, ~0u, "an unknown place"});
      continue;
    }
    // A device may believe the count or the byte count.
    const std::uint32_t bytes = known->many && message.size() > 6 ? message[6] : 0;
    const std::uint32_t count = known->many ? std::max<std::uint32_t>(word_at(message, 4), known->bits ? bytes * 8 : bytes / 2) : 1;
    result.push_back(written(known->bits, word_at(message, 2), count));
  }
  return result;
}

}  // namespace fieldproof::modbus
