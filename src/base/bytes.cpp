#include "src/base/bytes.hpp"

namespace fieldproof {

Bytes to_bytes(std::string_view text) { return Bytes(text.begin(), text.end()); }

std::string to_text(ByteView bytes) { return std::string(bytes.begin(), bytes.end()); }

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  return -1;
}

char hex_char(unsigned value) { return "0123456789ABCDEF"[value & 0xF]; }

std::string hex_number(std::uint64_t value, int digits) {
  std::string text(static_cast<std::size_t>(digits), '0');
  for (int i = digits - 1; i >= 0; --i, value >>= 4)
    text[static_cast<std::size_t>(i)] = hex_char(value & 0xF);
  return text;
}

std::string to_hex(ByteView bytes) {
  std::string text;
  text.reserve(bytes.size() * 3);
  for (Byte b : bytes) {
    if (!text.empty()) text += ' ';
    text += hex_char(b >> 4);
    text += hex_char(b);
  }
  return text;
}

std::optional<Bytes> from_hex(std::string_view text) {
  Bytes bytes;
  int high = -1;
  for (char c : text) {
    if (c == ' ' || c == '\t' || c == '\n' || c == '\r') {
      if (high >= 0) return std::nullopt;  // a byte may not be split
      continue;
    }
    const int digit = hex_digit(c);
    if (digit < 0) return std::nullopt;
    if (high < 0) {
      high = digit;
    } else {
      bytes.push_back(static_cast<Byte>(high << 4 | digit));
      high = -1;
    }
  }
  if (high >= 0) return std::nullopt;
  return bytes;
}

}  // namespace fieldproof
