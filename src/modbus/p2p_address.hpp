// How a P2P block of a Modbus client names memory of its partner, and the function code that
// follows from it (Cnet EN tables 6.2.2 and 10.3.2, Cnet KO 6.4.2):
//
//   0x40001   the leading digit is the table, the four hex digits behind it the data address,
//             counted from zero
//
//   table                  type   read   write single   write continuous
//   0   coils              bit    01     05             0F
//   1   inputs             bit    02     -              -
//   3   input registers    word   04     -              -
//   4   holding registers  word   03     06             10
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "src/base/bytes.hpp"
#include "src/p2p/block.hpp"

namespace fieldproof::modbus {

struct ModbusP2pAddress {
  char table = 0;
  std::uint32_t address = 0;

  /// Bits, or words?
  bool bits() const { return table < '3'; }
  /// Inputs can only be read.
  bool writable() const { return table == '0' || table == '4'; }
};

/// Nothing where it is none of the form above. Hex digits of either case.
std::optional<ModbusP2pAddress> parse_modbus_p2p_address(std::string_view text);

/// `block` reads or writes, and what it writes is writable.
Byte modbus_p2p_function(const p2p::P2pBlock& block, const ModbusP2pAddress& partner);

}  // namespace fieldproof::modbus
