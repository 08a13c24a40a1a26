// The checks of Modbus frames (Cnet EN and KO 9.3.1, 9.3.2).
#pragma once

#include <cstdint>

#include "src/base/bytes.hpp"

namespace fieldproof::modbus {

/// CRC-16 of an RTU frame: polynomial A001 (reflected), start value FFFF. The frame carries its low
/// byte first.
std::uint16_t modbus_crc(ByteView bytes);

/// LRC of an ASCII frame: the two's complement of the sum of the bytes before they become
/// characters.
Byte modbus_lrc(ByteView bytes);

}  // namespace fieldproof::modbus
