// What a Modbus server does with a PDU: function code and data, without station and check (Cnet EN
// and KO 9.2.2, 9.3.3, 9.4, Appendix 3.2). Words high byte first; the lowest bit address is bit 0
// of the first byte.
//
// Order of checks (DECISIONS.md modbus/order-of-checks): function 01; length, count, byte count and
// the value of FC 05 03; range 02. Further decisions: modbus/read-only-areas, modbus/fc0f-padding.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "src/base/bytes.hpp"
#include "src/modbus/data_space.hpp"

namespace fieldproof::modbus {

/// Exception codes (9.2.2). 04 to 06 are those of a server in trouble, which the emulated one never
/// is.
namespace modbus_exception {
constexpr Byte none = 0, function = 1, address = 2, value = 3;
}

/// The values of FC 05.
constexpr unsigned coil_on = 0xFF00, coil_off = 0x0000;

/// Appends the low 16 bits, high byte first.
void put_word(Bytes& to, std::uint64_t value);
/// The two bytes from `at` on, high byte first; they must be there.
std::uint16_t word_at(ByteView bytes, std::size_t at);

struct ModbusFunction {
  Byte code = 0;
  std::string_view name;  // of table 6.1.1
  ModbusBase base{};
  unsigned limit = 0;  // bits or words; FC 10: of a line
};

/// Words that FC 10 writes at most: on a line (Cnet KO 9.3.3), by TCP (FEnet EN table 5-41).
constexpr unsigned line_write_limit = 120, tcp_write_limit = 123;

/// 01 02 03 04 05 06 0F 10
std::span<const ModbusFunction> modbus_functions();
/// nullptr when unknown.
const ModbusFunction* find_modbus_function(Byte code);

struct ModbusRequest {
  Byte code = 0;
  const ModbusFunction* function = nullptr;  // nullptr: unknown
  Byte exception =
      modbus_exception::none;  // what can be told without the tables: function or value
  std::uint32_t address = 0;   // data address
  std::uint32_t count = 0;     // bits or words
  ByteView data{};  // to write: FC 05 and 06 the two bytes, 0F and 10 what follows the byte count
};

/// Never fails: `exception` says what is wrong. `pdu` has at least one byte and must outlive the
/// request.
ModbusRequest parse_modbus_request(ByteView pdu, unsigned write_limit = line_write_limit);

/// The PDU of the reply; a write has happened then, all of it or, with an exception, nothing.
Bytes execute_modbus_request(const ModbusRequest& request, DataSpace& data);

/// Function code with bit 7 set, and the exception code.
Bytes modbus_exception_reply(Byte code, Byte exception);

}  // namespace fieldproof::modbus
