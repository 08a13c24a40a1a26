// How a protocol frames a body that it shares with others.
#pragma once

#include <string_view>

namespace fieldproof::notation {

/// How a protocol frames a shared body. Supplied by the protocol; lives as long as the program.
struct Dressing {
  /// One frame in notation, with ${station} and ${body}, and where it has them ${transaction}, and
  /// ${wrong} behind the check that may be wrong: "[${station} ${body} CRC${wrong}]".
  std::string_view frame;
  /// Each byte of station and body travels as two hex digits.
  bool digits = false;
};

}  // namespace fieldproof::notation
