#include "reports/history/table.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "reports/text/markdown_text.hpp"
#include "reports/text/xml_text.hpp"

namespace fieldproof::history {

namespace {

std::string line_of(const std::vector<std::string>& cells, const std::vector<std::size_t>& widths) {
  std::string line;
  for (std::size_t i = 0; i < cells.size(); ++i)
    line += fmt::format("  {:<{}}", text::xml_line(cells[i]), widths[i]);
  line.erase(line.find_last_not_of(' ') + 1);
  return line + '\n';
}

std::string markdown_line(const std::vector<std::string>& cells) {
  std::string line = "|";
  for (const std::string& cell : cells) line += ' ' + text::markdown_cell(cell) + " |";
  return line + '\n';
}

}  // namespace

std::string table_text(const std::string& heading, const Table& table, std::size_t limit,
                       const std::string& more) {
  if (table.rows.empty()) return "";
  const std::size_t shown = limit == 0 ? table.rows.size() : std::min(limit, table.rows.size());
  std::vector<std::size_t> widths;
  for (const std::string& name : table.head) widths.push_back(name.size());
  for (std::size_t r = 0; r < shown; ++r)
    for (std::size_t i = 0; i < widths.size(); ++i)
      widths[i] = std::max(widths[i], text::xml_line(table.rows[r][i]).size());
  std::string text = fmt::format("\n{} ({})\n", heading, table.rows.size());
  text += line_of(table.head, widths);
  for (std::size_t r = 0; r < shown; ++r) text += line_of(table.rows[r], widths);
  if (shown < table.rows.size())
    text += fmt::format("  ... and {} more{}\n", table.rows.size() - shown, more);
  return text;
}

std::string table_markdown(const std::string& heading, const Table& table) {
  if (table.rows.empty()) return "";
  std::string text = fmt::format("\n## {} ({})\n\n", heading, table.rows.size());
  text += markdown_line(table.head) + '|';
  for (std::size_t i = 0; i < table.head.size(); ++i) text += " --- |";
  text += '\n';
  for (const std::vector<std::string>& row : table.rows) text += markdown_line(row);
  return text;
}

}  // namespace fieldproof::history
