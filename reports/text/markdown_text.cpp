#include "reports/text/markdown_text.hpp"

#include "reports/text/xml_text.hpp"

namespace fieldproof::text {

std::string markdown_cell(std::string_view text) {
  constexpr std::string_view markup = "\\`*_{}[]()<>#+!|~&";
  std::string escaped;
  std::string line(text);
  for (char& c : line)
    if (c == '\n' || c == '\t') c = ' ';
  for (const char c : xml_line(line)) {
    if (markup.find(c) != std::string_view::npos) escaped += '\\';
    escaped += c;
  }
  return escaped;
}

std::string markdown_row(std::initializer_list<std::string_view> cells) {
  std::string row = "|";
  for (const std::string_view cell : cells) row += ' ' + markdown_cell(cell) + " |";
  return row + '\n';
}

std::string markdown_head(std::initializer_list<std::string_view> cells) {
  std::string rule = "|";
  for (std::size_t i = 0; i < cells.size(); ++i) rule += " --- |";
  return markdown_row(cells) + rule + '\n';
}

}  // namespace fieldproof::text
