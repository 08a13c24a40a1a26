#include "suites/modbus/memory_requests.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>

#include "harness/device_names.hpp"
#include "harness/notation/beginning.hpp"
#include "src/plc/config_reader.hpp"
#include "suites/modbus/functions.hpp"
#include "suites/modbus/message.hpp"

namespace fieldproof::modbus_suite {

using harness::Protocol;
using modbus::ModbusBase;

namespace {

constexpr std::size_t words_at_once = 59;
constexpr std::size_t bytes_at_once = 2 * words_at_once;

/// Where a device address lies in the tables.
struct Place {
  bool bits = false;
  bool writable = false;       // by its table
  bool area_writable = false;  // DECISIONS.md modbus/read-only-areas
  std::uint32_t size = 0;      // of the table
  char type = 0;
  std::uint32_t address = 0;  // data address of the first element
  std::uint32_t width = 0;    // data addresses an element: bits or words
};

/// The table that `index` of an area lies behind the base of, the writable one first.
std::optional<ModbusBase> table_of(const Bases& bases, const plc::DeviceAddress& first, bool bits) {
  using enum ModbusBase;
  for (const ModbusBase base : {bits ? bit_write : word_write, bits ? bit_read : word_read}) {
    const plc::DeviceAddress& begin = bases.tables[base].first;
    if (begin.area == first.area && begin.contact == first.contact && begin.index <= first.index)
      return base;
  }
  return std::nullopt;
}

Result<Place> place_of(const Bases& bases, std::string_view name) {
  if (name.starts_with('@'))
    return fail(fmt::format("{} is a counter, which no function code reaches", name));
  const plc::ParsedAddress parsed = plc::parse_address(*bases.model, name);
  if (!parsed) return fail(fmt::format("cannot reach {}: {}", name, plc::describe(parsed.fault)));
  plc::DeviceAddress first = parsed.address;
  const bool bits = first.type == 'X' || first.type == 'B';
  const std::uint32_t width = first.type == 'X'   ? 1
                              : first.type == 'B' ? 8
                                                  : plc::type_bytes(first.type) / 2;
  first.index *= width;
  const std::optional<ModbusBase> base = table_of(bases, first, bits);
  if (!base) return fail(fmt::format("{} lies outside the Modbus bases of the device", name));
  const modbus::ModbusTable& table = bases.tables[*base];
  const bool writable = *base == ModbusBase::bit_write || *base == ModbusBase::word_write;
  return Place{bits,
               writable,
               bases.model->areas[first.area].write,
               table.size,
               parsed.address.type,
               first.index - table.first.index,
               width};
}

struct Slice {
  std::uint32_t address = 0;
  std::uint32_t count = 0;  // bits or words
  std::size_t digit = 0;    // of the first element
  std::size_t digits = 0;
};

/// Cuts `digits` of memory into parts of one request each, of at most `most` elements.
Result<std::vector<Slice>> parts_of(const Place& place, std::string_view name, std::size_t digits,
                                    std::size_t most) {
  const std::size_t element = plc::type_bytes(place.type) * 2;
  if (digits == 0 || digits % element != 0)
    return fail(fmt::format("{} digits are not a whole number of elements of {} ({} digits each)",
                            digits, name, element));
  const std::size_t elements = digits / element;
  if (place.address + elements * place.width > place.size)
    return fail(fmt::format("{} lies past data address {}, the last one", name, place.size - 1));
  std::vector<Slice> parts;
  for (std::size_t done = 0; done < elements; done += most) {
    const std::size_t count = std::min(most, elements - done);
    parts.push_back({static_cast<std::uint32_t>(place.address + done * place.width),
                     static_cast<std::uint32_t>(count * place.width), done * element,
                     count * element});
  }
  return parts;
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
  for (std::size_t i = 0; i < values.size(); ++i)
    bytes[i / 8] |= static_cast<Byte>((values[i] & 1) << (i % 8));
  return bytes;
}

/// Words in the order of their addresses; an element of several stands most significant first, in
/// words of `width`.
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
  if (message.size() < 2) return "the answer is no frame: " + notation::print_beginning(reply);
  if (!(message[1] & exception_bit)) return std::nullopt;
  const Byte code = message.size() > 2 ? message[2] : Byte{};
  const std::string_view meaning = exception_meaning(code);
  return fmt::format("the device answers exception {:02X}{}{}", code,
                     meaning.empty() ? ", which no manual has" : " ", meaning);
}

/// Functions of the Modbus standard that write and that the manual does not have: a file, a mask,
/// read and write.
bool writes_elsewhere(Byte function) { return function >= 0x15 && function <= 0x17; }

const modbus::ModbusTable& table_for(const Bases& bases, const FunctionCode& function) {
  return bases.tables[base_of(function)];
}

/// `count` data addresses of a table.
Protocol::Written memory_at(const Bases& bases, const FunctionCode& function,
                            std::uint32_t data_address, std::uint32_t count) {
  const modbus::ModbusTable& table = table_for(bases, function);
  Protocol::Written memory =
      harness::memory_of(*bases.model, table.first + data_address, count, "");
  memory.address = memory.contacts ? fmt::format("%{}X{}", memory.area, memory.first_word)
                                   : fmt::format("%{}W{}", memory.area, memory.first_word);
  return memory;
}

constexpr std::size_t address_at = 2, address_size = 2;  // in a message

}  // namespace

ModbusBase base_of(const FunctionCode& function) {
  const auto found = std::ranges::find(modbus::modbus_base_names, function.base);
  return static_cast<ModbusBase>(found - modbus::modbus_base_names.begin());
}

std::uint32_t count_in(ByteView message, const FunctionCode& function) {
  const bool counted = function.many || !function.write;
  return counted && message.size() >= 6 ? word_at(message, 4) : 1;
}

const Bases& default_bases() {
  static const Bases bases = *declared_bases("", nlohmann::json::object());
  return bases;
}

nlohmann::json default_base_config(std::string_view model) {
  nlohmann::json config = nlohmann::json::object();
  const plc::PlcModel* known = plc::find_plc_model(model);
  if (!known) return config;
  const modbus::ModbusBases bases = modbus::default_modbus_bases(*known);
  for (std::size_t i = 0; i < bases.size(); ++i)
    config[std::string(modbus::modbus_base_names[i]) + "_base"] = bases[i];
  return config;
}

Result<Bases> declared_bases(std::string_view model, const nlohmann::json& config) {
  const plc::PlcModel* known =
      model.empty() ? &plc::plc_models().front() : plc::find_plc_model(model);
  if (!known)
    return fail(
        fmt::format("there is no model '{}'; use one of {}", model, plc::plc_model_names()));
  modbus::ModbusBases bases = modbus::default_modbus_bases(*known);
  plc::ConfigReader reader(config, "the Modbus bases");
  for (std::size_t i = 0; i < bases.size(); ++i)
    reader.text((std::string(modbus::modbus_base_names[i]) + "_base").c_str(), bases[i]);
  bool separate = false;
  reader.either("tables", "separate", "overlapping", separate);
  if (reader.error()) return *reader.error();
  const Result<modbus::ModbusTables> tables = modbus::place_modbus_tables(*known, bases);
  if (!tables) return tables.error();
  return Bases{known, *tables, separate};
}

bool same_setting(std::string_view model, const std::string& key, const std::string& one,
                  const std::string& other) {
  if (one == other) return true;
  for (std::size_t i = 0; i < modbus::modbus_base_names.size(); ++i) {
    if (key != std::string(modbus::modbus_base_names[i]) + "_base") continue;
    const Result<Bases> first = declared_bases(model, {{key, one}}),
                        second = declared_bases(model, {{key, other}});
    const auto base = static_cast<ModbusBase>(i);
    return first && second && first->tables[base].first == second->tables[base].first;
  }
  return false;
}

Result<std::vector<Bytes>> write_requests(const Framing& framing, const Bases& bases, int station,
                                          std::string_view address, std::string_view hex) {
  const Result<Place> place = place_of(bases, address);
  if (!place) return place.error();
  if (!place->area_writable) return fail(fmt::format("{} is read only over the protocol", address));
  if (!place->writable)
    return fail(fmt::format(
        "{} is read only with the bases of the device (function codes 02 and 04)", address));
  const std::size_t most =
      place->type == 'X' ? bytes_at_once * 8 : bytes_at_once / plc::type_bytes(place->type);
  const Result<std::vector<Slice>> parts = parts_of(*place, address, hex.size(), most);
  if (!parts) return parts.error();
  std::vector<Bytes> requests;
  for (const Slice& part : *parts) {
    const std::optional<Bytes> values = from_hex(hex.substr(part.digit, part.digits));
    if (!values) return fail(fmt::format("'{}' is not hex", hex));
    const Bytes data = place->type == 'X' ? packed_bits(*values)
                       : place->bits      ? *values
                                          : words_in_order(*values, place->width);
    Bytes message = message_of(station, place->bits ? 0x0F : 0x10, part.address, part.count);
    message.push_back(static_cast<Byte>(data.size()));
    message.insert(message.end(), data.begin(), data.end());
    requests.push_back(framing.wrap(message));
  }
  return requests;
}

Result<std::vector<Bytes>> read_requests(const Framing& framing, const Bases& bases, int station,
                                         std::string_view address, std::size_t digits) {
  const Result<Place> place = place_of(bases, address);
  if (!place) return place.error();
  const bool as_it_stands = place->type == 'B' || place->type == 'W';  // else one element a request
  const Result<std::vector<Slice>> parts = parts_of(
      *place, address, digits, as_it_stands ? bytes_at_once / plc::type_bytes(place->type) : 1);
  if (!parts) return parts.error();
  const Byte function = place->bits       ? (place->writable ? 0x01 : 0x02)
                        : place->writable ? 0x03
                                          : 0x04;
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
  if (const std::optional<std::string> why = refusal(framing.unwrap(reply), reply))
    return fail(*why);
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

bool answers(const Framing& framing, ByteView request, ByteView reply) {
  const Bytes asked = framing.unwrap(request), answer = framing.unwrap(reply);
  if (asked.size() < 6 || answer.size() < 3 || !framing.pairs(request, reply)) return false;
  if (answer[0] != asked[0] || (answer[1] & ~exception_bit) != asked[1]) return false;
  if (answer[1] & exception_bit) return true;
  const FunctionCode* function = find_function(asked[1]);
  if (!function) return false;
  if (function->write) return std::equal(answer.begin(), answer.end(), asked.begin());
  const unsigned count = word_at(asked, 4);
  return answer[2] == (function->bits ? (count + 7) / 8 : count * 2);
}

std::vector<WriteMessage> writes_in(const Framing& framing, ByteView request) {
  std::vector<WriteMessage> result;
  for (const Bytes& message : framing.messages(request)) {
    if (message.size() < 2) continue;
    const FunctionCode* known = find_function(message[1]);
    const bool writes = known ? known->write : writes_elsewhere(message[1]);
    if (!writes) continue;
    const bool placed = known && message.size() >= (known->many ? 6u : 4u);
    if (!placed) {
      result.emplace_back();
      continue;
    }
    // A device may believe the count or the byte count.
    const std::uint32_t bytes = known->many && message.size() > 6 ? message[6] : 0;
    const std::uint32_t count =
        known->many
            ? std::max<std::uint32_t>(word_at(message, 4), known->bits ? bytes * 8 : bytes / 2)
            : 1;
    const std::uint32_t asked = known->many ? word_at(message, 4) : 1;
    result.push_back({known, word_at(message, 2), asked, count});
  }
  return result;
}

std::vector<Protocol::Written> written_by(const Framing& framing, const Bases& bases,
                                          ByteView request) {
  std::vector<Protocol::Written> result;
  for (const WriteMessage& one : writes_in(framing, request))
    result.push_back(one.function ? memory_at(bases, *one.function, one.address, one.count)
                                  : Protocol::Written{"?", 0, ~0u, "an unknown place"});
  return result;
}

std::vector<Protocol::Place> places(const Bases& bases, const Protocol::Written& written) {
  std::vector<Protocol::Place> result;
  for (Protocol::Place& place : harness::places_on(*bases.model, written)) {
    const bool by_words =
        place_of(bases, place.address) && place_of(bases, place.address)->writable;
    const std::string bytes = fmt::format("%{}B{}", written.area, written.first_word * 2);
    const Result<Place> by_bits = place_of(bases, bytes);
    const bool bits = by_bits && by_bits->writable && !written.contacts && place.declared;
    // Where tables are separate nobody says which of the two was meant: both are kept.
    if (bits && (!by_words || bases.separate)) result.push_back({bytes, place.digits, true});
    if (!bits || by_words) result.push_back(std::move(place));
  }
  return result;
}

std::vector<Protocol::AddressField> address_fields(const Framing& framing, const Bases& bases,
                                                   ByteView frame, bool reply) {
  const Bytes message = framing.unwrap(frame);
  const FunctionCode* known =
      message.size() >= address_at + address_size ? find_function(message[1]) : nullptr;
  if (!known || (reply && !known->write)) return {};
  const std::uint32_t count = count_in(message, *known);
  const Framing::Spelling spelling = framing.spelling();
  return {{spelling.before + address_at * spelling.each, address_size * spelling.each,
           memory_at(bases, *known, word_at(message, address_at), count)}};
}

std::optional<Bytes> moved_field(const Framing& framing, const Bases& bases, ByteView frame,
                                 const Protocol::AddressField& field, int words) {
  const Bytes message = framing.unwrap(frame);
  const FunctionCode* known = find_function(message[1]);
  // Elsewhere it would no longer be about the end of its table.
  if (word_at(message, address_at) + count_in(message, *known) >= table_for(bases, *known).size)
    return std::nullopt;
  const int units = known->bits && !field.names.contacts ? words * 16 : words;
  const std::int64_t moved = std::int64_t{word_at(message, address_at)} + units;
  if (moved < 0 || moved > last_data_address) return std::nullopt;
  if (field.size > address_size) return to_bytes(hex_number(static_cast<std::uint64_t>(moved), 4));
  return Bytes{static_cast<Byte>(moved >> 8), static_cast<Byte>(moved)};
}

}  // namespace fieldproof::modbus_suite
