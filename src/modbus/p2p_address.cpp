#include "src/modbus/p2p_address.hpp"

namespace fieldproof::modbus {

std::optional<ModbusP2pAddress> parse_modbus_p2p_address(std::string_view text) {
  constexpr std::string_view prefix = "0x", tables = "0134";
  constexpr std::size_t address_digits = 4;
  if (!text.starts_with(prefix) || text.size() != prefix.size() + 1 + address_digits)
    return std::nullopt;
  ModbusP2pAddress parsed{text[prefix.size()]};
  if (tables.find(parsed.table) == std::string_view::npos) return std::nullopt;
  for (const char c : text.substr(prefix.size() + 1)) {
    const int digit = hex_digit(c);
    if (digit < 0) return std::nullopt;
    parsed.address = parsed.address << 4 | static_cast<std::uint32_t>(digit);
  }
  return parsed;
}

Byte modbus_p2p_function(const p2p::P2pBlock& block, const ModbusP2pAddress& partner) {
  const bool write = block.function == p2p::P2pBlock::Function::write;
  switch (partner.table) {
    case '0': return write ? (block.continuous ? 0x0F : 0x05) : 0x01;
    case '1': return 0x02;
    case '3': return 0x04;
    default: return write ? (block.continuous ? 0x10 : 0x06) : 0x03;
  }
}

}  // namespace fieldproof::modbus
