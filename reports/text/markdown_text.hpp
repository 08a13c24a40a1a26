// Any text in a cell of a Markdown table.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>

namespace fieldproof::text {

/// One line in which nothing is markup: what Markdown or HTML would read as such is escaped.
std::string markdown_cell(std::string_view text);

/// "| a | b |" and a line feed; cells are escaped.
std::string markdown_row(std::initializer_list<std::string_view> cells);
/// The first row of a table, and the rule below it.
std::string markdown_head(std::initializer_list<std::string_view> cells);

}  // namespace fieldproof::text
