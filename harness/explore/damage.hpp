// What a bad line makes of a frame: one place of it changed, and what was done in words. No check
// follows.
#pragma once

#include <string>

#include "harness/notation/notation.hpp"

namespace fieldproof::explore {

struct Damaged {
  notation::Notation notation;
  std::string change;
};

/// `at` is a byte of the frame.
Damaged flipped(Bytes frame, std::size_t at, unsigned bit);
Damaged dropped(Bytes frame, std::size_t at);
Damaged doubled(Bytes frame, std::size_t at);
/// The first `size` bytes.
Damaged cut(Bytes frame, std::size_t size);
Damaged with_byte_before(Bytes frame, Byte byte);
Damaged with_byte_behind(Bytes frame, Byte byte);
/// `at` is greater than 0. A pause of 0 ends a segment where there are such.
Damaged paused(ByteView frame, std::size_t at, notation::Pause pause);

}  // namespace fieldproof::explore
