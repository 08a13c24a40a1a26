// Bytes in a message of one line.
#pragma once

#include <fmt/format.h>

#include <string>

#include "harness/notation/notation.hpp"

namespace fieldproof::notation {

/// In notation; of more than 64 the beginning, and how many they are: a device may send any number.
inline std::string print_beginning(ByteView bytes) {
  constexpr std::size_t most = 64;
  if (bytes.size() <= most) return print_bytes(bytes);
  return fmt::format("{} ... ({} bytes)", print_bytes(bytes.first(most)), bytes.size());
}

}  // namespace fieldproof::notation
