// A check of the frame notation: a word in capitals, whose bytes are computed from those of its
// bracket. The protocol supplies its checks; devices under test and emulators have their own code.
#pragma once

#include <span>
#include <string_view>

#include "src/base/bytes.hpp"

namespace fieldproof::notation {

struct Check {
  std::string_view name;     // as vectors write it: "CRC"
  std::string_view field{};  // as `Protocol::explain` calls it, where that is another name
  std::size_t size = 2;      // bytes in the frame
  bool behind = false;  // covers what follows it in its bracket (a length), else what precedes it
  bool counts = false;  // tells how many bytes it covers, whatever they are
  /// The bytes over what it covers; `off` is added to the value: 1 makes it deliberately wrong.
  Bytes (*compute)(ByteView covered, unsigned off) = nullptr;
  /// Does a frame that begins so have none? (Literal bytes; others are 0.) nullptr: each has one.
  bool (*absent)(ByteView frame) = nullptr;

  Bytes over(ByteView covered) const { return compute(covered, 0); }
  Bytes wrong_over(ByteView covered) const { return compute(covered, 1); }
};
using Checks = std::span<const Check>;

/// By its name, or its field; nullptr when there is none.
inline const Check* find_check(Checks checks, std::string_view name) {
  for (const Check& check : checks)
    if (check.name == name || (!name.empty() && check.field == name)) return &check;
  return nullptr;
}

}  // namespace fieldproof::notation
