#include "suites/modbus/functions.hpp"

#include <algorithm>
#include <array>

namespace fieldproof::modbus_suite {

namespace {

constexpr std::array<FunctionCode, 8> functions{{
    {0x01, "Read Coil Status", "bit_write", "0XXXX", 2000, true, false, false},
    {0x02, "Read Input Status", "bit_read", "1XXXX", 2000, true, false, false},
    {0x03, "Read Holding Registers", "word_write", "4XXXX", 125, false, false, false},
    {0x04, "Read Input Registers", "word_read", "3XXXX", 125, false, false, false},
    {0x05, "Force Single Coil", "bit_write", "0XXXX", 1, true, true, false},
    {0x06, "Preset Single Register", "word_write", "4XXXX", 1, false, true, false},
    {0x0F, "Force Multiple Coils", "bit_write", "0XXXX", 1968, true, true, true},
    {0x10, "Preset Multiple Registers", "word_write", "4XXXX", 120, false, true, true},
}};

// 01 to 03 as Appendix 3.2 names them, 04 to 06 as 9.2.2 does.
constexpr std::array<std::string_view, 7> exceptions{
    "",
    "Illegal Function",
    "Illegal Address",
    "Illegal Data Value",
    "Server error",
    "Server requesting re-transmission",
    "Server process time delay",
};

}  // namespace

std::span<const FunctionCode> function_codes() { return functions; }

const FunctionCode* find_function(Byte code) {
  const auto found = std::ranges::find(functions, code, &FunctionCode::code);
  return found == functions.end() ? nullptr : &*found;
}

std::string_view exception_meaning(Byte code) {
  return code < exceptions.size() ? exceptions[code] : std::string_view();
}

}  // namespace fieldproof::modbus_suite
