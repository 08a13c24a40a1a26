// A table for the console and for Markdown.
#pragma once

#include <string>
#include <vector>

namespace fieldproof::history {

struct Table {
  std::vector<std::string> head;
  std::vector<std::vector<std::string>> rows;
};

/// Aligned columns below a heading with the count of rows; of more than `limit` rows, which is 0
/// for all, the first, and `more`: where the others are. Empty without rows.
std::string table_text(const std::string& heading, const Table& table, std::size_t limit = 0,
                       const std::string& more = "");
/// The same with all rows.
std::string table_markdown(const std::string& heading, const Table& table);

}  // namespace fieldproof::history
