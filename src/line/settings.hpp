// Speed and character format of a serial line (Cnet EN table 4.3.1: 1200 to 115200 bit/s, 7 or 8
// data bits, parity none, even or odd, 1 or 2 stop bits).
#pragma once

#include <string>
#include <string_view>

#include "src/base/result.hpp"
#include "src/base/time.hpp"

namespace fieldproof::line {

struct LineSettings {
  int baud = 9600;
  int data_bits = 8;
  char parity = 'N';  // N, E or O
  int stop_bits = 1;

  /// Start, data, parity and stop bits.
  int bits_per_character() const { return 1 + data_bits + (parity == 'N' ? 0 : 1) + stop_bits; }
  /// From the leading edge of the start bit to the end of the last stop bit.
  Duration character_time() const;

  bool operator==(const LineSettings&) const = default;
};

/// Reads "9600-8N1" or "9600"; the error names the part that is wrong and what is allowed.
Result<LineSettings> parse_line_settings(std::string_view text);
/// "9600-8N1"
std::string to_string(const LineSettings& settings);

}  // namespace fieldproof::line
