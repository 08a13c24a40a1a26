#include "reports/history/matrix_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "reports/history/table.hpp"

namespace fieldproof::history {

namespace {

constexpr std::size_t console_rows = 50;

std::vector<std::string> letters(const Matrix& matrix, std::vector<std::string> head) {
  for (std::size_t i = 0; i < matrix.columns.size(); ++i) head.push_back(column_letter(i));
  return head;
}

Table columns_table(const Matrix& matrix) {
  Table table{{"", "device or firmware", "last run", "started", "vectors", "cases"}, {}};
  for (std::size_t i = 0; i < matrix.columns.size(); ++i) {
    const MatrixColumn& one = matrix.columns[i];
    table.rows.push_back({column_letter(i), one.name, std::to_string(one.newest.number),
                          one.newest.started, one.newest.vectors, to_string(one.tally)});
  }
  return table;
}

bool is_news(const MatrixSection& section) {
  return std::ranges::any_of(section.rows,
                             [](const MatrixRow& row) { return row.differs || row.red; });
}

Table sections_table(const Matrix& matrix, bool news_alone) {
  Table table{letters(matrix, {"manual", "section"}), {}};
  for (const MatrixSection& section : matrix.sections) {
    if (news_alone && !is_news(section)) continue;
    std::vector<std::string>& row =
        table.rows.emplace_back(std::vector{section.name.manual, section.name.section});
    for (const text::Tally& tally : section.tallies) row.push_back(section_cell(tally));
  }
  return table;
}

Table cases_table(const Matrix& matrix, const std::vector<const MatrixRow*>& rows) {
  Table table{letters(matrix, {"case"}), {}};
  for (const MatrixRow* one : rows) {
    std::vector<std::string>& row = table.rows.emplace_back(std::vector{one->facts.name});
    for (const auto& cell : one->cells)
      row.emplace_back(cell ? results::to_string(*cell) : std::string_view("-"));
  }
  return table;
}

std::vector<const MatrixRow*> red_alike(const Matrix& matrix) {
  std::vector<const MatrixRow*> rows = rows_with(matrix, &MatrixRow::red);
  std::erase_if(rows, [](const MatrixRow* row) { return row->differs; });
  return rows;
}

std::string last_line(const Matrix& matrix) {
  const std::size_t differ = rows_with(matrix, &MatrixRow::differs).size();
  std::string text =
      fmt::format("\n{} cases, {} differ between the columns, {} are red in all that have them\n",
                  matrix.cases(), differ, red_alike(matrix).size());
  if (matrix.left_out > 0)
    text += fmt::format("{} columns with older runs are left out; --last 0 shows all\n",
                        matrix.left_out);
  return text;
}

}  // namespace

std::string matrix_text(const Matrix& matrix) {
  const auto table = [&](const char* heading, const std::vector<const MatrixRow*>& rows) {
    return table_text(heading, cases_table(matrix, rows), console_rows, "; --html FILE shows all");
  };
  return table_text("columns", columns_table(matrix)).substr(1) +
         table_text("sections with a case that differs or is red: cases judged",
                    sections_table(matrix, true)) +
         table("cases that differ", rows_with(matrix, &MatrixRow::differs)) +
         table("cases red in all that have them", red_alike(matrix)) + last_line(matrix);
}

std::string matrix_markdown(const Matrix& matrix) {
  return "# fieldproof history matrix\n" + table_markdown("Columns", columns_table(matrix)) +
         table_markdown("Sections: cases judged", sections_table(matrix, false)) +
         table_markdown("Cases that differ",
                        cases_table(matrix, rows_with(matrix, &MatrixRow::differs))) +
         table_markdown("Cases red in all that have them", cases_table(matrix, red_alike(matrix))) +
         last_line(matrix);
}

std::string matrix_json(const Matrix& matrix) {
  using nlohmann::ordered_json;
  ordered_json document{{"columns", ordered_json::array()}, {"sections", ordered_json::array()}};
  for (const MatrixColumn& one : matrix.columns)
    document["columns"].push_back({{"name", one.name},
                                   {"device", one.newest.device},
                                   {"firmware", one.newest.firmware},
                                   {"vectors", one.newest.vectors},
                                   {"started", one.newest.started},
                                   {"runs", one.runs}});
  for (const MatrixSection& section : matrix.sections) {
    ordered_json cases = ordered_json::array();
    for (const MatrixRow& row : section.rows) {
      ordered_json verdicts = ordered_json::array();
      for (const auto& cell : row.cells)
        verdicts.push_back(cell ? ordered_json(results::to_string(*cell)) : ordered_json());
      cases.push_back({{"id", row.facts.name},
                       {"title", row.facts.title},
                       {"differs", row.differs},
                       {"verdicts", std::move(verdicts)}});
    }
    document["sections"].push_back({{"manual", section.name.manual},
                                    {"section", section.name.section},
                                    {"cases", std::move(cases)}});
  }
  return document.dump(1) + '\n';
}

}  // namespace fieldproof::history
