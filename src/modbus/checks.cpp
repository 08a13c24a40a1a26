#include "src/modbus/checks.hpp"

namespace fieldproof::modbus {

std::uint16_t modbus_crc(ByteView bytes) {
  unsigned crc = 0xFFFF;
  for (const Byte b : bytes) {
    crc ^= b;
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ (crc & 1 ? 0xA001u : 0u);
  }
  return static_cast<std::uint16_t>(crc);
}

Byte modbus_lrc(ByteView bytes) {
  unsigned sum = 0;
  for (const Byte b : bytes) sum += b;
  return static_cast<Byte>(0u - sum);
}

}  // namespace fieldproof::modbus
