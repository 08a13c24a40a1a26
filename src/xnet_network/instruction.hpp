// The data instructions of X-NET: BIT_READ, BIT_WRITE, REG_READ, REG_WRITE (1-2, 3-3-1), as one
// line of text that reads like the manual.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "src/base/result.hpp"
#include "src/xnet/areas.hpp"
#include "src/xnet/memory.hpp"

namespace fieldproof::xnet {

struct Instruction {
  bool reads = true, bits = false;
  std::uint32_t net = 0, station = 0;  // S1, S2
  unsigned type = 0;                   // S3: of the target's object
  std::uint32_t address = 0;           // S4
  std::uint32_t count = 0;             // S5
  Component local{};                   // D1 of reads, S6 of writes

  /// What it takes on a net: a register, or up to 16 coils (1-4, note 3).
  std::uint32_t words() const { return bits ? (count + 15) / 16 : count; }
};

/// "REG_READ net 1 station 2 D0 count 10 to D10", "BIT_WRITE net 1 station 3 Y0 count 8 from M0";
/// the target also as "type 128 address 0". Numbers as the manual writes them: 10, K10, H0C0A8; or
/// a register of the PLC that executes it, with its `memory` (S4: two). Errors name the word.
Result<Instruction> read_instruction(std::string_view text, const Memory& memory);
bool is_instruction(std::string_view text);

}  // namespace fieldproof::xnet
