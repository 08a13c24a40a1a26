#include "harness/cli/frame_text.hpp"

#include <algorithm>

namespace fieldproof::cli {

namespace {

bool looks_like_hex(const std::string& text) {
  return std::ranges::all_of(text, [](char c) { return c == ' ' || hex_digit(c) >= 0; }) &&
         from_hex(text).has_value();
}

}  // namespace

Bytes read_monitor_text(const std::string& text) {
  Bytes bytes;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char close = text[i] == '[' ? ']' : text[i] == '<' ? '>' : '\0';
    const std::size_t end = close ? text.find(close, i) : std::string::npos;
    const Result<notation::Notation> word =
        end == std::string::npos ? Result<notation::Notation>(fail(""))
                                 : notation::parse_notation(text.substr(i + 1, end - i - 1));
    if (word && word->size() == 1 && word->front().bytes.size() == 1) {
      bytes.push_back(word->front().bytes.front());
      i = end;
    } else {
      bytes.push_back(static_cast<Byte>(text[i]));
    }
  }
  return bytes;
}

Result<Bytes> read_frame_text(const std::string& text, const notation::Fields& stations) {
  if (looks_like_hex(text)) return *from_hex(text);
  const Result<notation::Notation> notation = notation::parse_notation(text);
  if (!notation) {
    const bool raw = !text.empty() && (static_cast<unsigned char>(text[0]) < 0x20 ||
                                       text[0] == '[' || text[0] == '<');
    const bool monitor =
        raw && text.find('\'') == std::string::npos && text.find("] ") == std::string::npos;
    if (monitor) return read_monitor_text(text);
    return notation.error();
  }
  const Result<std::vector<notation::FrameTemplate>> templates =
      notation::make_templates(*notation, stations);
  if (!templates) return templates.error();
  return notation::render(templates->front(), {});
}

}  // namespace fieldproof::cli
