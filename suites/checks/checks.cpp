#include "suites/checks/checks.hpp"

#include <algorithm>
#include <numeric>

namespace fieldproof::checks {

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

Bytes two_digits(unsigned value) { return to_bytes(hex_number(value & 0xFF, 2)); }

/// Byte 3 (after header and station) is the main command.
bool main_command_is_upper_case(ByteView frame) {
  constexpr std::size_t command = 3;
  return command < frame.size() && frame[command] >= 'A' && frame[command] <= 'Z';
}

}  // namespace

const notation::Check bcc{
    .name = "BCC",
    .compute = [](ByteView covered, unsigned off) { return two_digits(sum_of(covered) + off); },
    .absent = main_command_is_upper_case};

const notation::Check sum{
    .name = "SUM", .compute = [](ByteView covered, unsigned off) {
      return two_digits((covered.empty() ? 0 : sum_of(covered.subspan(1))) + off);
    }};

const notation::Check crc{.name = "CRC", .compute = [](ByteView covered, unsigned off) {
                            const unsigned value = crc16(covered) + off;
                            return Bytes{static_cast<Byte>(value), static_cast<Byte>(value >> 8)};
                          }};

const notation::Check lrc{.name = "LRC", .compute = [](ByteView covered, unsigned off) {
                            return two_digits(lrc8(covered) + off);
                          }};

const notation::Check length{
    .name = "LEN",
    .field = "length",
    .behind = true,
    .counts = true,
    .compute = [](ByteView covered, unsigned off) {
      const auto value = static_cast<unsigned>(covered.size()) + off;
      return Bytes{static_cast<Byte>(value >> 8), static_cast<Byte>(value)};
    }};

const notation::Check fenet_length{
    .name = "LEN",
    .field = "length",
    .behind = true,
    .counts = true,
    .compute = [](ByteView covered, unsigned off) {
      constexpr std::size_t position_and_check = 2;
      const std::size_t body = covered.size() - std::min(covered.size(), position_and_check);
      const auto value = static_cast<unsigned>(body) + off;
      return Bytes{static_cast<Byte>(value), static_cast<Byte>(value >> 8)};
    }};

const notation::Check fenet_sum{
    .name = "SUM", .field = "check sum", .size = 1, .compute = [](ByteView covered, unsigned off) {
      return Bytes{static_cast<Byte>(sum_of(covered) + off)};
    }};

}  // namespace fieldproof::checks
