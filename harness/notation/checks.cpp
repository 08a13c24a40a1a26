#include "harness/notation/checks.hpp"

#include <numeric>

namespace fieldproof::notation {

namespace {

unsigned sum_of(ByteView bytes) { return std::accumulate(bytes.begin(), bytes.end(), 0u); }

unsigned crc16(ByteView bytes) {
  unsigned crc = 0xFFFF;
  for (Byte b : bytes) {
    crc ^= b;
    for (int bit = 0; bit < 8; ++bit) crc = (crc & 1) ? (crc >> 1) ^ 0xA001 : crc >> 1;
  }
  return crc;
}

/// Digits that are no hex count as zero: such a frame is wrong in another way already.
unsigned lrc8(ByteView bytes) {
  unsigned sum = 0;
  for (std::size_t i = 1; i + 1 < bytes.size(); i += 2) {
    const int high = hex_digit(static_cast<char>(bytes[i]));
    const int low = hex_digit(static_cast<char>(bytes[i + 1]));
    sum += static_cast<unsigned>((high < 0 ? 0 : high) << 4 | (low < 0 ? 0 : low));
  }
  return (0x100 - (sum & 0xFF)) & 0xFF;
}

Bytes encode(CheckKind kind, unsigned value) {
  if (kind == CheckKind::crc)
    return {static_cast<Byte>(value & 0xFF), static_cast<Byte>(value >> 8 & 0xFF)};
  return to_bytes(hex_number(value & 0xFF, 2));
}

unsigned value_of(CheckKind kind, ByteView frame) {
  switch (kind) {
    case CheckKind::bcc: return sum_of(frame);
    case CheckKind::sum: return frame.empty() ? 0 : sum_of(frame.subspan(1));
    case CheckKind::crc: return crc16(frame);
    case CheckKind::lrc: return lrc8(frame);
  }
  return 0;
}

}  // namespace

std::string_view to_string(CheckKind kind) {
  switch (kind) {
    case CheckKind::bcc: return "BCC";
    case CheckKind::sum: return "SUM";
    case CheckKind::crc: return "CRC";
    case CheckKind::lrc: return "LRC";
  }
  return "";
}

Bytes compute_check(CheckKind kind, ByteView frame) { return encode(kind, value_of(kind, frame)); }

Bytes compute_wrong_check(CheckKind kind, ByteView frame) {
  return encode(kind, value_of(kind, frame) + 1);
}

}  // namespace fieldproof::notation
