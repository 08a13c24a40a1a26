#include "suites/modbus/placing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "harness/device_names.hpp"
#include "suites/modbus/functions.hpp"
#include "suites/modbus/message.hpp"

namespace fieldproof::modbus_suite {

using harness::Protocol;
using modbus::ModbusBase;

namespace {

constexpr std::size_t digits_of_a_word = 4;

bool is_bit_table(ModbusBase base) {
  return base == ModbusBase::bit_read || base == ModbusBase::bit_write;
}

/// Of inputs and input registers: no function code writes it.
bool is_read_table(ModbusBase base) {
  return base == ModbusBase::bit_read || base == ModbusBase::word_read;
}

Bases defaults_of(const Bases& declared) {
  return *declared_bases(declared.model->name, nlohmann::json::object());
}

/// A table, and the memory that a request asks of it where the default bases put it.
struct Asked {
  ModbusBase table{};
  Protocol::Written memory;
};

std::vector<Asked> asked_by(const std::vector<Bytes>& requests, const Framing& framing,
                            const Bases& defaults) {
  std::vector<Asked> asked;
  for (const Bytes& request : requests)
    for (const Bytes& message : framing.messages(request))
      if (const FunctionCode* function = message.size() > 1 ? find_function(message[1]) : nullptr)
        for (Protocol::AddressField& field :
             address_fields(framing, defaults, framing.wrap(message), false))
          asked.push_back({base_of(*function), std::move(field.names)});
  return asked;
}

/// In words; a base of bits may begin inside one.
struct Origin {
  char area = 0;
  bool contact = false;
  std::int64_t word = 0;
  std::uint32_t bit = 0;
};
Origin origin_of(const Bases& bases, ModbusBase base) {
  const plc::DeviceAddress& first = bases.tables[base].first;
  const bool bits = is_bit_table(base) && !first.contact;
  return {bases.model->areas[first.area].letter, first.contact,
          bits ? first.index / 16 : first.index, bits ? first.index % 16 : 0};
}

bool holds(const Origin& table, const Protocol::Written& memory) {
  return memory.area == std::string(1, table.area) && memory.contacts == table.contact &&
         table.word <= memory.first_word;
}

/// The tables to which a place belongs: those of which it is asked, else, of all that the case
/// asks, those that it could lie in, of its own kind before the others.
std::set<ModbusBase> tables_of(const Protocol::Written& memory, bool named_by_bits,
                               const std::vector<Asked>& asked, const Bases& defaults) {
  std::set<ModbusBase> of_it, of_its_kind, others;
  for (const Asked& one : asked) {
    if (one.memory.overlaps(memory)) of_it.insert(one.table);
    if (!holds(origin_of(defaults, one.table), memory)) continue;
    (is_bit_table(one.table) == named_by_bits ? of_its_kind : others).insert(one.table);
  }
  if (!of_it.empty()) return of_it;
  return of_its_kind.empty() ? others : of_its_kind;
}

/// The same name in another area, so many words further on. No name is on the wire.
std::optional<std::string> renamed(const plc::PlcModel& model, std::string_view address, char area,
                                   std::int64_t words) {
  std::string name(address);
  const std::size_t letter = name.starts_with('%') ? 1 : 0;
  name[letter] = area;
  if (words == 0) return plc::parse_address(model, name) ? std::optional(name) : std::nullopt;
  return harness::moved_name(model, name, static_cast<int>(words), harness::Digits::any);
}

bool is_named_by_bits(const Bases& bases, std::string_view address) {
  const plc::ParsedAddress parsed = plc::parse_address(*bases.model, address);
  return parsed && (parsed.address.type == 'X' || parsed.address.type == 'B');
}

/// Words that only requests for bits reach, as bytes.
Protocol::Placed in_bytes(const Protocol::Written& memory, std::string_view hex) {
  Protocol::Placed placed{fmt::format("%{}B{}", memory.area, memory.first_word * 2), ""};
  for (std::size_t i = 0; i + digits_of_a_word <= hex.size(); i += digits_of_a_word)
    placed.hex += std::string(hex.substr(i + 2, 2)) + std::string(hex.substr(i, 2));
  return placed;
}

/// As the tables that are asked reach it: by bits, or by words.
Result<Protocol::Placed> as_asked(const Bases& declared, const Protocol::Placed& placed,
                                  bool bits) {
  if (is_named_by_bits(declared, placed.address) == bits) return placed;
  const plc::ParsedAddress parsed = plc::parse_address(*declared.model, placed.address);
  const auto memory = harness::named_memory(*declared.model, placed.address, placed.hex.size());
  if (bits && memory && parsed && parsed.address.type == 'W') return in_bytes(*memory, placed.hex);
  return fail(
      fmt::format("needs {} to be read and written by both bits and words; the profile "
                  "declares separate tables",
                  placed.address));
}

}  // namespace

Result<Protocol::Placed> placed(const Framing& framing, const Bases& declared,
                                std::string_view address, std::string_view hex,
                                const std::vector<Bytes>& requests) {
  const Protocol::Placed unmoved{std::string(address), std::string(hex)};
  const auto memory = harness::named_memory(*declared.model, address, hex.size());
  if (!memory) return unmoved;
  const Bases defaults = defaults_of(declared);
  std::optional<std::string> place;
  bool bits = false, words = false;
  const std::vector<Asked> asked = asked_by(requests, framing, defaults);
  for (const ModbusBase table :
       tables_of(*memory, is_named_by_bits(defaults, address), asked, defaults)) {
    const Origin from = origin_of(defaults, table), to = origin_of(declared, table);
    if (declared.separate && is_read_table(table))
      return fail(
          fmt::format("sets {}, which is read as {}, and no function code writes them; the "
                      "profile declares separate tables",
                      address, is_bit_table(table) ? "inputs" : "input registers"));
    (is_bit_table(table) ? bits : words) = true;
    const bool whole = from.bit == to.bit && from.contact == to.contact;
    const std::optional<std::string> name =
        whole ? renamed(*declared.model, address, to.area, to.word - from.word) : std::nullopt;
    if (!name)
      return fail(fmt::format("names {}, and there is no such place behind the declared {}_base",
                              address, modbus::modbus_base_names[static_cast<std::size_t>(table)]));
    if (place && *place != *name)
      return fail(
          fmt::format("reaches {} by two tables, which the declared bases put apart ({} and {})",
                      address, *place, *name));
    place = name;
  }
  if (!place) return unmoved;
  const Protocol::Placed moved{*place, std::string(hex)};
  if (declared.separate && bits && words)
    return fail(fmt::format("reaches {} by bits and by words; the profile declares separate tables",
                            address));
  if (declared.separate) return as_asked(declared, moved, bits);
  // Where words are for reading alone, or no table of words is, those of bits may lead there.
  const auto settable = [&](const Protocol::Placed& one) {
    return bool(write_requests(framing, declared, 1, one.address, one.hex));
  };
  if (!bits || settable(moved)) return moved;
  const Result<Protocol::Placed> by_bits = as_asked(declared, moved, true);
  return by_bits && settable(*by_bits) ? *by_bits : moved;
}

std::string tied_to_default(const Framing& framing, const Bases& declared,
                            const std::vector<Bytes>& requests) {
  const Bases defaults = defaults_of(declared);
  for (const Bytes& request : requests)
    for (const Bytes& message : framing.messages(request)) {
      const FunctionCode* function = message.size() >= 4 ? find_function(message[1]) : nullptr;
      if (!function) continue;
      const ModbusBase base = base_of(*function);
      const std::uint32_t before = defaults.tables[base].size, now = declared.tables[base].size;
      const std::uint32_t end = word_at(message, 2) + count_in(message, *function);
      if (before != now && end > std::min(before, now) && word_at(message, 2) <= last_data_address)
        return fmt::format(
            "is about the end of a table, {} data addresses with the default {}_base and {} with "
            "the declared one",
            before, function->base, now);
    }
  return {};
}

}  // namespace fieldproof::modbus_suite
