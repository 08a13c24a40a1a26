#include "src/user_frames/checks.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>

namespace fieldproof::user_frames {

namespace {

constexpr Byte dle = 0x10;
constexpr std::uint16_t xor_start = 0xFF, crc_start = 0xFFFF;

constexpr std::array methods{
    CheckMethodFacts{CheckMethod::byte_sum, "byte_sum"},
    CheckMethodFacts{CheckMethod::word_sum, "word_sum", 2},
    CheckMethodFacts{CheckMethod::byte_xor, "byte_xor", 1, xor_start},
    CheckMethodFacts{CheckMethod::sum_7bit, "7bit_sum"},
    CheckMethodFacts{CheckMethod::xor_7bit, "7bit_xor", 1, xor_start},
    CheckMethodFacts{CheckMethod::sum_7bit_1, "7bit_sum_1"},
    CheckMethodFacts{CheckMethod::sum_2s_complement, "byte_sum_2s_comp"},
    CheckMethodFacts{CheckMethod::sum_1s_complement, "byte_sum_1s_comp"},
    CheckMethodFacts{CheckMethod::crc_16, "crc_16", 2, crc_start},
    CheckMethodFacts{CheckMethod::lgis_crc, "lgis_crc", 0, 0, true},
    CheckMethodFacts{CheckMethod::dle_ab, "dle_ab", 1, 0, true},
    CheckMethodFacts{CheckMethod::dle_siemens, "dle_siemens", 1, 0, true},
};

unsigned sum_of(unsigned start, ByteView bytes) {
  for (const Byte b : bytes) start += b;
  return start;
}

unsigned xor_of(unsigned start, ByteView bytes) {
  for (const Byte b : bytes) start ^= b;
  return start;
}

unsigned word_sum(unsigned start, ByteView bytes, bool low_first) {
  for (std::size_t i = 0; i < bytes.size(); i += 2) {
    const unsigned first = bytes[i], second = i + 1 < bytes.size() ? bytes[i + 1] : 0u;
    start += low_first ? first | second << 8 : first << 8 | second;
  }
  return start;
}

unsigned crc_16(unsigned crc, ByteView bytes) {
  for (const Byte b : bytes) {
    crc ^= b;
    for (int bit = 0; bit < 8; ++bit) crc = crc & 1 ? crc >> 1 ^ 0xA001 : crc >> 1;
  }
  return crc;
}

/// DF1 doubles a DLE among the data and counts it once.
unsigned sum_of_undoubled(ByteView bytes) {
  unsigned sum = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    sum += bytes[i];
    if (bytes[i] == dle && i + 1 < bytes.size() && bytes[i + 1] == dle) ++i;
  }
  return sum;
}

unsigned value_of(CheckMethod method, const CheckOptions& options, ByteView bytes) {
  constexpr unsigned seven_bits = 0x7F, printable = 0x20;
  switch (method) {
    case CheckMethod::byte_sum: return sum_of(options.start, bytes);
    case CheckMethod::word_sum: return word_sum(options.start, bytes, options.low_first);
    case CheckMethod::byte_xor: return xor_of(options.start, bytes);
    case CheckMethod::sum_7bit: return sum_of(options.start, bytes) & seven_bits;
    case CheckMethod::xor_7bit: return xor_of(options.start, bytes) & seven_bits;
    case CheckMethod::sum_7bit_1: {
      const unsigned sum = sum_of(options.start, bytes) & seven_bits;
      return sum < printable ? sum + printable : sum;
    }
    case CheckMethod::sum_2s_complement: return 0u - sum_of(options.start, bytes);
    case CheckMethod::sum_1s_complement: return ~sum_of(options.start, bytes);
    case CheckMethod::crc_16: return crc_16(options.start, bytes);
    case CheckMethod::dle_ab: return 0u - sum_of_undoubled(bytes);
    case CheckMethod::dle_siemens: return xor_of(0, bytes);
    case CheckMethod::lgis_crc: break;
  }
  throw std::logic_error("compute_check: LGIS CRC is not known");
}

}  // namespace

std::span<const CheckMethodFacts> check_methods() { return methods; }

const CheckMethodFacts& facts_of(CheckMethod method) {
  return *std::ranges::find(methods, method, &CheckMethodFacts::method);
}

const CheckMethodFacts* find_check_method(std::string_view name) {
  const auto found = std::ranges::find(methods, name, &CheckMethodFacts::name);
  return found == methods.end() ? nullptr : &*found;
}

std::size_t check_size(CheckMethod method, bool ascii) {
  return facts_of(method).bytes * (ascii ? 2 : 1);
}

Bytes compute_check(CheckMethod method, const CheckOptions& options, ByteView covered) {
  const unsigned value = value_of(method, options, covered);
  Bytes bytes{static_cast<Byte>(value & 0xFF)};
  if (facts_of(method).bytes == 2) {
    bytes.push_back(static_cast<Byte>(value >> 8 & 0xFF));
    if (!options.low_first) std::ranges::reverse(bytes);
  }
  if (!options.ascii) return bytes;
  Bytes digits;
  for (const Byte b : bytes)
    for (const char c : hex_number(b, 2)) digits.push_back(static_cast<Byte>(c));
  return digits;
}

}  // namespace fieldproof::user_frames
