#include "reports/text/xml_text.hpp"

#include <algorithm>
#include <cstdint>

#include "src/base/bytes.hpp"

namespace fieldproof::text {
namespace {

struct Character {
  std::uint32_t code = 0;
  std::size_t length = 0;  // 0: not UTF-8
};

/// The character at the front of `text` (RFC 3629: shortest form, no surrogates, up to U+10FFFF).
Character decode(std::string_view text) {
  const auto at = [&](std::size_t i) -> std::uint32_t { return static_cast<Byte>(text[i]); };
  const std::uint32_t lead = at(0);
  if (lead < 0x80) return {lead, 1};
  const std::size_t length = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
  if (lead < 0xC2 || lead > 0xF4 || text.size() < length) return {};
  std::uint32_t code = lead & (0x7Fu >> length);
  for (std::size_t i = 1; i < length; ++i) {
    if ((at(i) & 0xC0u) != 0x80u) return {};
    code = code << 6 | (at(i) & 0x3Fu);
  }
  const bool overlong = (length == 3 && code < 0x800) || (length == 4 && code < 0x10000);
  const bool surrogate = code >= 0xD800 && code <= 0xDFFF;
  if (overlong || surrogate || code > 0x10FFFF) return {};
  return {code, length};
}

bool readable(std::uint32_t code, bool multi_line) {
  if (code == '\n' || code == '\t') return multi_line;
  return code >= 0x20 && !(code >= 0x7F && code <= 0x9F) && code != 0xFFFE && code != 0xFFFF;
}

std::string show(std::string_view bytes, bool multi_line) {
  const auto plain = [](unsigned char c) { return c >= 0x20 && c < 0x7F; };
  if (std::ranges::all_of(bytes, plain)) return std::string(bytes);
  std::string text;
  text.reserve(bytes.size());
  while (!bytes.empty()) {
    const Character next = decode(bytes);
    const std::size_t length = next.length == 0 ? 1 : next.length;
    if (next.length != 0 && readable(next.code, multi_line)) {
      text += bytes.substr(0, length);
    } else {
      for (char byte : bytes.substr(0, length))
        text += '[' + hex_number(static_cast<Byte>(byte), 2) + ']';
    }
    bytes.remove_prefix(length);
  }
  return text;
}

void append_escaped(std::string& xml, std::string_view clean, std::string_view marks) {
  for (std::size_t at = 0;;) {
    const std::size_t next = std::min(clean.find_first_of(marks, at), clean.size());
    xml += clean.substr(at, next - at);
    if (next == clean.size()) return;
    switch (clean[next]) {
      case '&': xml += "&amp;"; break;
      case '<': xml += "&lt;"; break;
      case '>': xml += "&gt;"; break;
      default: xml += "&quot;"; break;
    }
    at = next + 1;
  }
}

}  // namespace

void append_content(std::string& xml, std::string_view clean) { append_escaped(xml, clean, "&<>"); }
void append_value(std::string& xml, std::string_view clean) { append_escaped(xml, clean, "&<>\""); }

std::string xml_text(std::string_view bytes) { return show(bytes, true); }
std::string xml_line(std::string_view bytes) { return show(bytes, false); }

}  // namespace fieldproof::text
