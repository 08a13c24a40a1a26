// The header of XGT FEnet frames (FEnet EN 5.2.3, table 5-3; 5.2.5), numbers low byte first.
//
//   company id (10)  PLC info (2)  CPU info (1)  source (1)  invoke id (2)  length (2)
//   position (1)  check (1)
//
// `length` counts the bytes of the body behind the header. `check` is the low byte of the sum of
// the 19 bytes before it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "src/base/bytes.hpp"

namespace fieldproof::xgt_fenet {

constexpr std::size_t header_size = 20;

using CompanyId = std::array<Byte, 10>;
/// "LSIS-XGT" and two zeros; "LGIS-GLOFA" (table 5-5).
constexpr CompanyId lsis_xgt{'L', 'S', 'I', 'S', '-', 'X', 'G', 'T', 0, 0};
constexpr CompanyId lgis_glofa{'L', 'G', 'I', 'S', '-', 'G', 'L', 'O', 'F', 'A'};

/// Who sends: table 5-3, 'Source of Frame'.
constexpr Byte from_client = 0x33, from_server = 0x11;
/// Its CPU: 'CPU Info', XGB of the MK and of the IEC series.
constexpr Byte cpu_xgb = 0xB0, cpu_xgb_iec = 0xB4;

struct Header {
  CompanyId company = lsis_xgt;
  std::uint16_t plc_info = 0;
  Byte cpu_info = 0;
  Byte source = from_client;
  std::uint16_t invoke = 0;
  std::uint16_t length = 0;  // of the body
  Byte position = 0;         // base x 16 + slot of the module
  Byte check = 0;            // as it stands there; `encode` computes it

  bool is_known_company() const { return company == lsis_xgt || company == lgis_glofa; }
  std::size_t frame_size() const { return header_size + length; }
};

/// Nothing while fewer than header_size bytes have come.
std::optional<Header> read_header(ByteView bytes);

/// The check of a frame of which at least all that it covers is there.
Byte header_check(ByteView frame);

/// Header and body, with the right length and check. The body has at most 65535 bytes.
Bytes encode_frame(const Header& header, ByteView body);

/// Low byte first. Both bytes must be there.
constexpr std::uint16_t word_at(ByteView bytes, std::size_t at) {
  return static_cast<std::uint16_t>(bytes[at] | bytes[at + 1] << 8);
}
inline void put_word(Bytes& bytes, std::size_t value) {
  const Byte word[] = {static_cast<Byte>(value), static_cast<Byte>(value >> 8)};
  bytes.insert(bytes.end(), word, word + 2);
}

}  // namespace fieldproof::xgt_fenet
