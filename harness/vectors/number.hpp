// Numbers in the memory of a vector as a manual writes them, for PLCs whose larger numbers lie in
// several words, the low one first: dec(1500), dec32(-20000), dec64(0), float(0.5); what is checked
// may lie between two: dec32(631..641).
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace fieldproof::vectors {

struct Number {
  unsigned bits = 16;  // 16, 32, 64
  bool floating = false;
  double low = 0, high = 0;  // whole numbers to 2 to the 53rd are exact

  bool is_range() const { return low != high; }
  /// Of `low`: hex digits, the low word first.
  std::string digits() const;
  /// What such digits hold; `digits` are as many as those of digits().
  double value_of(std::string_view digits) const;
  bool holds(std::string_view digits) const;
  /// "1500", "0.5", "631 to 641".
  std::string text() const;
  std::string text_of(std::string_view digits) const;
};

/// Nothing: it has none of these forms, or the number does not fit.
std::optional<Number> read_number(std::string_view text);

}  // namespace fieldproof::vectors
