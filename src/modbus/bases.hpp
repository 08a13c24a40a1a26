// Where the four Modbus tables lie in the PLC's memory (Cnet EN and KO 6.1.3, 9.3.3).
//
//   base         table               functions  a base is entered as
//   bit_read     1XXXX bit input     02         bit address: P0100 is word 10 bit 0; XEC flat:
//                                               M160, IX0.0.5
//   bit_write    0XXXX bit output    01 05 0F   bit address
//   word_read    3XXXX word input    04         word address: P010
//   word_write   4XXXX word output   03 06 10   word address
//
// Data address 0 is the base. A table ends at data address 9998 (Modbus addresses are 1-9999) or
// with the device area, whichever is first (DECISIONS.md modbus/end-of-tables; the 1249 bytes
// of 6.1.3 would be 9992 bits). Tables may overlap.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "src/base/result.hpp"
#include "src/plc/address.hpp"

namespace fieldproof::modbus {

enum class ModbusBase { bit_read, bit_write, word_read, word_write };
constexpr std::array<std::string_view, 4> modbus_base_names{"bit_read", "bit_write", "word_read",
                                                            "word_write"};

/// As entered in the dialog, by ModbusBase.
using ModbusBases = std::array<std::string, 4>;

/// P0, M0, P0, M0; XEC: I0, M0, I0, M0.
ModbusBases default_modbus_bases(const plc::PlcModel& model);

/// Data addresses 0 to size - 1 are the elements from `first` on.
struct ModbusTable {
  plc::DeviceAddress first;
  std::uint32_t size = 0;
};

class ModbusTables {
 public:
  const ModbusTable& operator[](ModbusBase base) const {
    return tables_[static_cast<std::size_t>(base)];
  }

 private:
  friend Result<ModbusTables> place_modbus_tables(const plc::PlcModel& model,
                                                  const ModbusBases& bases);
  std::array<ModbusTable, 4> tables_;
};

/// A base is an area letter and a number as in device names; % in front, and X or W behind the
/// letter, may be there. Bits of T and C are contacts; D has none (7.1.4 Note). Errors name the
/// base and what is wrong with it.
Result<ModbusTables> place_modbus_tables(const plc::PlcModel& model, const ModbusBases& bases);

}  // namespace fieldproof::modbus
