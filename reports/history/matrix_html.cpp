#include "reports/history/matrix_html.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "reports/html/html_page.hpp"

namespace fieldproof::history {

using html::HtmlWriter;
using results::Verdict;
using text::grouped;

namespace {

/// A longer table is folded, so that what comes after it is in sight.
constexpr std::size_t most_open = 200;

void write_verdicts(HtmlWriter& out, const MatrixRow& row) {
  for (const auto& cell : row.cells)
    out.element("td", {}, [&] {
      if (cell)
        html::write_verdict(out, *cell);
      else
        out.text("\u2013");
    });
}

void write_rows(HtmlWriter& out, const Matrix& matrix, const std::vector<const MatrixRow*>& rows) {
  out.element("div", {{"class", "scroll"}}, [&] {
    out.element("table", {{"class", "list"}}, [&] {
      out.element("thead", {}, [&] {
        out.element("tr", {}, [&] {
          out.element("th", {}, "Case");
          for (std::size_t i = 0; i < matrix.columns.size(); ++i)
            out.element("th", {}, column_letter(i));
        });
      });
      out.element("tbody", {}, [&] {
        for (const MatrixRow* row : rows) {
          out.element("tr", {}, [&] {
            out.element("th", {}, [&] {
              out.element("code", {}, row->facts.name);
              out.element("small", {}, row->facts.title);
            });
            write_verdicts(out, *row);
          });
          out.markup("\n");
        }
      });
    });
  });
}

void write_named_rows(HtmlWriter& out, const Matrix& matrix, const std::string& heading,
                      const std::vector<const MatrixRow*>& rows) {
  if (rows.empty()) return;
  out.element("h2", {}, fmt::format("{} {}", grouped(rows.size()), heading));
  if (rows.size() <= most_open) return write_rows(out, matrix, rows);
  out.element("details", {}, [&] {
    out.element("summary", {}, "show them");
    write_rows(out, matrix, rows);
  });
}

void write_columns(HtmlWriter& out, const Matrix& matrix) {
  out.element("table", {{"class", "list"}}, [&] {
    for (std::size_t i = 0; i < matrix.columns.size(); ++i) {
      const MatrixColumn& one = matrix.columns[i];
      out.element("tr", {}, [&] {
        out.element("th", {}, column_letter(i));
        out.element("td", {}, [&] {
          out.element("b", {}, one.name);
          out.element(
              "small", {},
              fmt::format(
                  "{}last run {} of {}{}, vectors {}",
                  one.newest.firmware.empty() ? ""
                                              : fmt::format("firmware {}, ", one.newest.firmware),
                  one.newest.number, one.newest.started,
                  one.runs.size() > 1 ? fmt::format(" and {} before it", one.runs.size() - 1) : "",
                  one.newest.vectors));
        });
        out.element("td", {}, to_string(one.tally));
      });
    }
  });
}

/// All alike is one word, whatever the number of columns.
void write_section_rows(HtmlWriter& out, const MatrixSection& section) {
  out.element("table", {{"class", "passes"}}, [&] {
    for (const MatrixRow& row : section.rows) {
      out.element("tr", {}, [&] {
        out.element("th", {}, row.facts.name);
        out.element("td", {}, [&] {
          const bool alike =
              std::ranges::adjacent_find(row.cells, std::ranges::not_equal_to()) == row.cells.end();
          for (std::size_t i = 0; i < (alike ? 1 : row.cells.size()); ++i) {
            if (!row.cells[i]) continue;
            if (!alike) out.text(column_letter(i) + "\u00A0");
            html::write_verdict(out, *row.cells[i]);
            out.text(" ");
          }
        });
      });
      out.markup("\n");
    }
  });
}

void write_section(HtmlWriter& out, const MatrixSection& section) {
  out.element("details", {{"class", "section"}}, [&] {
    out.element("summary", {}, [&] {
      out.element("span", {{"class", "name"}}, section.name.manual + ' ' + section.name.section);
      for (std::size_t i = 0; i < section.tallies.size(); ++i) {
        const text::Tally& tally = section.tallies[i];
        const std::string cell = section_cell(tally);
        const Verdict colour = tally.gating({}) > 0 ? Verdict::fail : Verdict::pass;
        if (cell == "-")
          out.element("span", {{"class", "none"}}, "\u2013");
        else
          out.element("span",
                      {{"class", html::verdict_class(colour)}, {"data-verdict", column_letter(i)}},
                      cell);
      }
    });
    write_section_rows(out, section);
  });
  out.markup("\n");
}

void write_sections(HtmlWriter& out, const Matrix& matrix) {
  out.element("h2", {}, "All cases by section");
  const std::string columns = fmt::format("--columns:{}", matrix.columns.size());
  out.element("div", {{"class", "scroll"}}, [&] {
    out.element("div", {{"class", "matrix"}, {"style", columns}}, [&] {
      out.element("div", {{"class", "head"}}, [&] {
        out.element("span", {{"class", "name"}}, "Cases judged");
        for (std::size_t i = 0; i < matrix.columns.size(); ++i)
          out.element("span", {}, column_letter(i));
      });
      for (const MatrixSection& section : matrix.sections) write_section(out, section);
    });
  });
}

}  // namespace

std::string matrix_html(const Matrix& matrix) {
  const std::vector<const MatrixRow*> differing = rows_with(matrix, &MatrixRow::differs);
  std::vector<const MatrixRow*> red = rows_with(matrix, &MatrixRow::red);
  const std::string title = differing.empty()
                                ? "No case differs"
                                : fmt::format("{} of {} cases differ", grouped(differing.size()),
                                              grouped(matrix.cases()));
  HtmlWriter body;
  body.element("div", {{"class", red.empty() ? "banner good" : "banner bad"}}, [&] {
    body.element("p", {{"class", "device"}}, "fieldproof history matrix");
    body.element("h1", {}, title);
    body.element("p", {{"class", "detail"}},
                 fmt::format("{} columns, {} cases, {} of them red in one or more",
                             matrix.columns.size(), grouped(matrix.cases()), grouped(red.size())));
    if (matrix.left_out > 0)
      body.element("p", {{"class", "detail"}},
                   fmt::format("{} columns with older runs are left out", matrix.left_out));
  });
  write_columns(body, matrix);
  std::erase_if(red, [](const MatrixRow* row) { return row->differs; });
  write_named_rows(body, matrix, "cases that differ", differing);
  write_named_rows(body, matrix, "cases red in all that have them", red);
  write_sections(body, matrix);
  return html::html_page("fieldproof history: " + title, body);
}

}  // namespace fieldproof::history
