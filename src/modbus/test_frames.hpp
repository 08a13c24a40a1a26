// For tests: bytes as hex, and frames around them.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "src/modbus/frame.hpp"
#include "src/plc/test_frame_log.hpp"

namespace fieldproof::modbus::test {

constexpr Duration character = 1ms, gap = 4ms;

inline Bytes hex(std::string_view text) {
  const auto bytes = from_hex(text);
  if (!bytes) throw std::invalid_argument("a test has wrong hex: " + std::string(text));
  return *bytes;
}

/// Station and PDU in hex, as a frame.
inline Bytes framed(ModbusMode mode, std::string_view text) {
  const Bytes content = hex(text);
  return encode_modbus_frame(mode, content.at(0), ByteView(content).subspan(1));
}
inline Bytes rtu(std::string_view text) { return framed(ModbusMode::rtu, text); }
inline Bytes ascii(std::string_view text) { return framed(ModbusMode::ascii, text); }

inline Bytes operator+(Bytes a, const Bytes& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

inline Bytes part(const Bytes& bytes, std::size_t from, std::size_t until) {
  return Bytes(bytes.begin() + static_cast<std::ptrdiff_t>(from),
               bytes.begin() + static_cast<std::ptrdiff_t>(until));
}

}  // namespace fieldproof::modbus::test
