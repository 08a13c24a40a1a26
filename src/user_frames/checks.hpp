// The error checks of user-defined frames (Cnet KO 6.5.1 'BCC error check').
//
// The manual describes them in words. What it leaves open is settled in
// suites/user_frames/definitions/README.md: byte order, left-over bytes, start values. Sources
// beyond the manual:
//   DLE AB       DF1: two's complement of the sum of the data between DLE STX and DLE ETX, DLE DLE
//                counted once (Rockwell 1770-6.5.16, 5-3; 5370-CVIM manual, 5-29 prints two
//                examples)
//   DLE SIEMENS  3964R: exclusive or of the data block, DLE and ETX (Euchner HBLS manual, 8.3
//                'equal to 3964R')
//   LGIS CRC     none found: it has a name here, so that a definition that asks for it can be told
//                why not
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "src/base/bytes.hpp"

namespace fieldproof::user_frames {

enum class CheckMethod {
  byte_sum,
  word_sum,
  byte_xor,
  sum_7bit,
  xor_7bit,
  sum_7bit_1,
  sum_2s_complement,
  sum_1s_complement,
  crc_16,
  lgis_crc,
  dle_ab,
  dle_siemens
};

struct CheckMethodFacts {
  CheckMethod method;
  std::string_view name;    // in a definition: "byte_sum"
  std::size_t bytes = 1;    // of the result, before ASCII conversion; 0: the algorithm is not known
  std::uint16_t start = 0;  // value before the first byte, unless the definition sets another
  bool dedicated = false;   // covers what its protocol says; nothing to set
};

/// The twelve, in the order of the manual.
std::span<const CheckMethodFacts> check_methods();
const CheckMethodFacts& facts_of(CheckMethod method);
/// nullptr when unknown.
const CheckMethodFacts* find_check_method(std::string_view name);

struct CheckOptions {
  std::uint16_t start = 0;  // FF, or FFFF of 16 bits
  bool ascii = false;       // upper-case hex digits: twice as long
  bool low_first = true;    // 16-bit results, and the words that word_sum adds

  bool operator==(const CheckOptions&) const = default;
};

/// Bytes of the result in the frame.
std::size_t check_size(CheckMethod method, bool ascii);

/// The check of `covered` as it stands in the frame. `method` is not lgis_crc (std::logic_error).
Bytes compute_check(CheckMethod method, const CheckOptions& options, ByteView covered);

}  // namespace fieldproof::user_frames
