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

ModbusBase table_of(const FunctionCode& function) {
  const auto found = std::ranges::find(modbus::modbus_base_names, function.base);
  return static_cast<ModbusBase>(found - modbus::modbus_base_names.begin());
}

/// The tables that requests name.
std::set<ModbusBase> tables_of(const Framing& framing, const std::vector<Bytes>& requests) {
  std::set<ModbusBase> tables;
  for (const Bytes& request : requests)
    for (const Bytes& message : framing.messages(request))
      if (const FunctionCode* function = message.size() > 1 ? find_function(message[1]) : nullptr)
        tables.insert(table_of(*function));
  return tables;
}

Bases defaults_of(const Bases& declared) {
  return *declared_bases(declared.model->name, nlohmann::json::object());
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
  return {bases.model->areas[first.area].letter, first.contact, bits ? first.index / 16 : first.index,
          bits ? first.index % 16 : 0};
}

bool holds(const Origin& table, const Protocol::Written& memory) {
  return memory.area == std::string(1, table.area) && memory.contacts == table.contact &&
         table.word <= memory.first_word;
}

/// The same name in another area, so many words further on.
std::optional<std::string> renamed(const plc::PlcModel& model, std::string_view address, char area,
                                   std::int64_t words) {
  std::string name(address);
  const std::size_t letter = name.starts_with('%') ? 1 : 0;
  name[letter] = area;
  if (words == 0) return plc::parse_address(model, name) ? std::optional(name) : std::nullopt;
  return harness::moved_name(model, name, static_cast<int>(words));
}

/// Words of tables that lie apart from those of words, as the bytes that requests for bits reach.
Protocol::Placed in_bytes(const Protocol::Written& memory, std::string_view hex) {
  Protocol::Placed placed{fmt::format("%{}B{}", memory.area, memory.first_word * 2), ""};
  for (std::size_t i = 0; i + digits_of_a_word <= hex.size(); i += digits_of_a_word)
    placed.hex += std::string(hex.substr(i + 2, 2)) + std::string(hex.substr(i, 2));
  return placed;
}

/// Coils and registers of a device that has them apart.
Result<Protocol::Placed> apart(const Bases& declared, const Protocol::Placed& placed, bool bits) {
  const plc::ParsedAddress parsed = plc::parse_address(*declared.model, placed.address);
  const char type = parsed ? parsed.address.type : 'W';
  const bool named_by_bits = type == 'X' || type == 'B';
  if (named_by_bits == bits) return placed;
  const auto memory = harness::named_memory(*declared.model, placed.address, placed.hex.size());
  if (bits && type == 'W' && memory) return in_bytes(*memory, placed.hex);
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
  for (const ModbusBase table : tables_of(framing, requests)) {
    const Origin from = origin_of(defaults, table), to = origin_of(declared, table);
    if (!holds(from, *memory)) continue;
    (is_bit_table(table) ? bits : words) = true;
    const bool whole = from.bit == to.bit && from.contact == to.contact;
    const std::optional<std::string> name =
        whole ? renamed(*declared.model, address, to.area, to.word - from.word) : std::nullopt;
    if (!name)
      return fail(fmt::format("names {}, and there is no such place behind the declared {}_base",
                              address, modbus::modbus_base_names[static_cast<std::size_t>(table)]));
    if (place && *place != *name)
      return fail(
          fmt::format("reaches {} by two tables, which the declared bases put apart ({} and "
                      "{})",
                      address, *place, *name));
    place = name;
  }
  if (!place) return unmoved;
  const Protocol::Placed moved{*place, std::string(hex)};
  if (!declared.separate) return moved;
  if (bits && words)
    return fail(fmt::format("reaches {} by bits and by words; the profile declares separate tables",
                            address));
  return apart(declared, moved, bits);
}

std::string tied_to_default(const Framing& framing, const Bases& declared,
                            const std::vector<Bytes>& requests) {
  const Bases defaults = defaults_of(declared);
  for (const Bytes& request : requests)
    for (const Bytes& message : framing.messages(request)) {
      const FunctionCode* function = message.size() >= 4 ? find_function(message[1]) : nullptr;
      if (!function) continue;
      const ModbusBase base = table_of(*function);
      const std::uint32_t before = defaults.tables[base].size, now = declared.tables[base].size;
      const bool counted = (function->many || !function->write) && message.size() >= 6;
      const std::uint32_t end = word_at(message, 2) + (counted ? word_at(message, 4) : 1);
      if (before != now && end > std::min(before, now) && word_at(message, 2) <= last_data_address)
        return fmt::format(
            "is about the end of a table, {} data addresses with the default {}_base and {} with "
            "the declared one",
            before, function->base, now);
    }
  return {};
}

}  // namespace fieldproof::modbus_suite
