// Bytes as values, and their hex form.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace fieldproof {

using Byte = std::uint8_t;
using Bytes = std::vector<Byte>;
using ByteView = std::span<const Byte>;

/// The bytes of a text, one for one.
Bytes to_bytes(std::string_view text);
/// The text of bytes, one for one.
std::string to_text(ByteView bytes);

/// "05 30 31": upper-case hex, separated by single spaces.
std::string to_hex(ByteView bytes);
/// Reads "05 30 31", "053031" or a mix; nullopt when a digit is missing or foreign.
std::optional<Bytes> from_hex(std::string_view text);

/// The value of one hex digit (either case), or -1.
int hex_digit(char c);
/// Upper-case digit of a value 0-15.
char hex_char(unsigned value);
/// `value` as `digits` upper-case hex digits, most significant first.
std::string hex_number(std::uint64_t value, int digits);

}  // namespace fieldproof
