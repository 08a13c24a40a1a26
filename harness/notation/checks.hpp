// The checks of the frame notation, computed here and nowhere else: devices under test and the
// emulator have their own.
#pragma once

#include <string_view>

#include "src/base/bytes.hpp"

namespace fieldproof::notation {

enum class CheckKind {
  bcc,  // XGT (Cnet EN 7.1.5): low byte of the sum from header to tail, two hex digits
  sum,  // LS Bus (Cnet EN 8): low byte of the sum between header and sum, two hex digits
  crc,  // Modbus RTU (Cnet EN 9.3): CRC-16, polynomial A001, start FFFF, low byte first
  lrc   // Modbus ASCII (Cnet EN 9.3): two's complement of the sum of the bytes that the hex pairs
        // after
        // ':' stand for
};

/// "BCC", "SUM", "CRC", "LRC"
std::string_view to_string(CheckKind kind);

/// Every check is two bytes in the frame.
inline constexpr std::size_t check_size = 2;

/// The two bytes of the check over `frame`: the bytes of the bracket before the check.
Bytes compute_check(CheckKind kind, ByteView frame);

/// The same, deliberately wrong: the value plus one.
Bytes compute_wrong_check(CheckKind kind, ByteView frame);

}  // namespace fieldproof::notation
