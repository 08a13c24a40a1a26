#include "src/modbus/bases.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace fieldproof::modbus {

namespace {
constexpr std::uint32_t modbus_addresses = 9999;

bool holds_bits(ModbusBase base) {
  return base == ModbusBase::bit_read || base == ModbusBase::bit_write;
}

/// "P0100" and "%PX0100" become "%PX0100". Only a type letter of the other kind is left to be
/// wrong.
std::string device_name(std::string_view base, char type) {
  if (base.starts_with('%')) base.remove_prefix(1);
  const std::string_view number = base.substr(std::min<std::size_t>(1, base.size()));
  const bool typed = !number.empty() && (number[0] & ~0x20) == type;
  return fmt::format("%{}{}{}", base.substr(0, 1),
                     typed ? std::string_view() : std::string_view(&type, 1), number);
}

Result<ModbusTable> place(const plc::PlcModel& model, ModbusBase base, std::string_view text) {
  const bool bits = holds_bits(base);
  const plc::ParsedAddress parsed = plc::parse_address(model, device_name(text, bits ? 'X' : 'W'));
  if (!parsed) {
    return fail(fmt::format("cannot place {}_base '{}' on {}: {}; give a {} address such as {}",
                            modbus_base_names[static_cast<std::size_t>(base)], text, model.name,
                            plc::describe(parsed.fault), bits ? "bit" : "word",
                            bits ? "M0010" : "M001"));
  }
  const std::uint32_t elements =
      plc::element_count(model.areas[parsed.address.area], parsed.address.type);
  return ModbusTable{parsed.address, std::min(modbus_addresses, elements - parsed.address.index)};
}
}  // namespace

ModbusBases default_modbus_bases(const plc::PlcModel& model) {
  const std::string input = model.iec ? "I0" : "P0";
  return {input, "M0", input, "M0"};
}

Result<ModbusTables> place_modbus_tables(const plc::PlcModel& model, const ModbusBases& bases) {
  ModbusTables tables;
  for (std::size_t i = 0; i < bases.size(); ++i) {
    const Result<ModbusTable> table = place(model, static_cast<ModbusBase>(i), bases[i]);
    if (!table) return table.error();
    tables.tables_[i] = *table;
  }
  return tables;
}

}  // namespace fieldproof::modbus
