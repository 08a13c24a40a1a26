#include "suites/email/frame_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

#include "suites/checks/control_bytes.hpp"

namespace fieldproof::email_suite {

using harness::Field;

namespace {

constexpr std::string_view line_end = "\r\n", text_end = "\r\n.\r\n";
constexpr std::array<std::string_view, 12> commands{"AUTH", "DATA", "EHLO", "EXPN", "HELO", "HELP",
                                                    "MAIL", "NOOP", "QUIT", "RCPT", "RSET", "VRFY"};

bool is_reply(std::string_view line) {
  return line.size() >= 3 &&
         std::ranges::all_of(line.substr(0, 3), [](char c) { return c >= '0' && c <= '9'; });
}

bool is_command(std::string_view line) {
  return std::ranges::find(commands, line.substr(0, 4)) != commands.end() &&
         (line.size() == 4 || line[4] == ' ');
}

/// Splits off what `name` is called.
void add(std::vector<Field>& fields, std::string name, std::string_view text, std::size_t& at) {
  fields.push_back({std::move(name), at, text.size(), checks::printable(to_bytes(text)), {}});
  at += text.size();
}

std::vector<Field> explain_line(std::string_view line) {
  std::vector<Field> fields;
  std::size_t at = 0;
  const std::size_t end = std::min(line.find(line_end), line.size());
  const bool reply = is_reply(line);
  const std::size_t first = std::min<std::size_t>(reply ? 3 : 4, end);
  add(fields, reply ? "code" : "command", line.substr(0, first), at);
  if (end > first) add(fields, reply ? "words" : "argument", line.substr(first, end - first), at);
  if (at < line.size()) add(fields, "end of line", line.substr(at), at);
  return fields;
}

std::string line_name(std::string_view line, bool header, int number) {
  const std::size_t colon = line.find(':');
  if (header && colon != std::string_view::npos) return std::string(line.substr(0, colon));
  if (header) return line.empty() ? "end of the header" : "header line";
  return fmt::format("line {}", number);
}

std::vector<Field> explain_text(std::string_view text) {
  std::vector<Field> fields;
  bool header = true;
  int number = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = text.find(line_end, at);
    const std::string_view line = text.substr(at, end - at);
    const bool last = line == "." && end + line_end.size() == text.size();
    const std::string name = last ? "end" : line_name(line, header, number);
    header = header && !line.empty();
    number += !header;
    add(fields, name, text.substr(at, line.size() + (end == text.npos ? 0 : line_end.size())), at);
  }
  return fields;
}

}  // namespace

std::optional<std::size_t> frame_length(ByteView bytes) {
  const std::string text = to_text(bytes);
  const std::size_t end = text.find(line_end);
  if (end == std::string::npos) return std::nullopt;
  const std::string_view line = std::string_view(text).substr(0, end);
  if (is_reply(line) || is_command(line) || line == ".") return end + line_end.size();
  const std::size_t last = text.find(text_end);
  return last == std::string::npos ? std::nullopt : std::optional(last + text_end.size());
}

std::vector<Field> explain(ByteView frame) {
  if (frame.empty()) return {};
  const std::string text = to_text(frame);
  const std::string_view line = std::string_view(text).substr(0, text.find(line_end));
  return is_reply(line) || is_command(line) ? explain_line(text) : explain_text(text);
}

}  // namespace fieldproof::email_suite
