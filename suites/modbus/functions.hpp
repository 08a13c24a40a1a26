// The function and exception codes of the XGB Modbus servers as data (Cnet EN
// Table 6.1.1, 9.2.2, 9.3.3, 9.4).
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "src/base/bytes.hpp"

namespace fieldproof::modbus_suite {

struct FunctionCode {
  Byte code = 0;
  std::string_view name;  // as the manual prints it
  std::string_view
      base;  // whose address is data address 0: "bit_write" is bit_write_base of given.config
  std::string_view address;  // "0XXXX"
  std::uint32_t limit = 0;   // bits or words a request
  bool bits = false;
  bool write = false;
  bool many = false;  // a write with count and byte count
};

std::span<const FunctionCode> function_codes();
/// nullptr for a code that the manual does not have.
const FunctionCode* find_function(Byte code);

/// The meaning of an exception code (9.2.2, Appendix 3.2); empty for an unknown one.
std::string_view exception_meaning(Byte code);

/// Data addresses are 0 to this one: Modbus counts 1 to 9999 (6.1.3).
inline constexpr std::uint32_t last_data_address = 9998;

inline constexpr Byte exception_bit = 0x80;

}  // namespace fieldproof::modbus_suite
