#include "reports/coverage_html.hpp"

#include <fmt/format.h>

#include <span>

#include "reports/html/html_page.hpp"
#include "reports/text/report_file.hpp"

namespace fieldproof::reports {

using html::HtmlWriter;

namespace {

struct Column {
  Traced state;
  const char* head;
  const char* css;  // the colour of a verdict that means as much
};

std::vector<Column> columns_of(const Coverage& coverage) {
  std::vector<Column> columns{
      {Traced::tested, coverage.with_results() ? "held" : "with vectors", "v-pass"}};
  if (coverage.with_results())
    columns.insert(columns.end(), {{Traced::failed, "failed", "v-fail"},
                                   {Traced::unjudged, "not judged", "v-blocked"}});
  columns.push_back({Traced::measured, "measured", "v-info"});
  columns.push_back({Traced::table, "tables", "v-pass"});
  columns.push_back({Traced::reasoned, "reasons", "v-skip"});
  columns.push_back({Traced::open, "open", "v-fail"});
  return columns;
}

void write_banner(HtmlWriter& out, const Coverage& coverage) {
  const CoverageCounts counts = count_statements(coverage);
  out.element(
      "header",
      {{"class", counts.count(Traced::open) + counts.count(Traced::failed) == 0 ? "banner good"
                                                                                : "banner bad"}},
      [&] {
        out.element(
            "p", {{"class", "device"}},
            coverage.with_results() ? coverage.endpoint : "vectors " + coverage.vectors_hash);
        out.element(
            "h1", {},
            fmt::format("{:.1f} % of {} statements {}", counts.percent(coverage.with_results()),
                        counts.total, coverage.with_results() ? "were judged" : "have a vector"));
        out.element("p", {{"class", "detail"}}, coverage_summary(coverage));
      });
}

void write_vectors(HtmlWriter& out, const CoverageStatement& statement, bool with_results) {
  for (const CoverageVector& vector : statement.vectors) {
    out.element("div", {{"title", vector.title}}, [&] {
      out.element("code", {}, vector.id);
      for (const results::Verdict verdict : text::Tally::verdicts) {
        if (!with_results || vector.verdicts.of(verdict) == 0) continue;
        out.markup(" ");
        html::write_verdict(out, verdict);
        out.text(fmt::format(" {}", vector.verdicts.of(verdict)));
      }
    });
  }
}

void write_statement(HtmlWriter& out, const CoverageStatement& statement, bool with_results) {
  out.element("tr", {}, [&] {
    out.element("th", {}, [&] {
      out.text(statement.quote);
      out.element("small", {}, statement.id);
    });
    out.element("td", {{"style", "width:55%"}}, [&] {
      write_vectors(out, statement, with_results);
      out.element("small", {}, trace_text(statement, with_results));
    });
  });
}

/// The statements of one section; the first of `statements` says which.
void write_section(HtmlWriter& out, std::span<const CoverageStatement> statements,
                   std::string_view title, const std::vector<Column>& columns, bool with_results) {
  CoverageCounts counts;
  for (const CoverageStatement& statement : statements) counts.add(statement.state(with_results));
  out.element("details", {{"class", "section"}}, [&] {
    out.element("summary", {}, [&] {
      out.element("span", {{"class", "name"}}, [&] {
        out.text(statements.front().section);
        if (!title.empty()) out.element("i", {}, title);
      });
      for (const Column& column : columns) {
        const std::size_t count = counts.count(column.state);
        out.element("span",
                    {{"class", count == 0 ? "none" : column.css}, {"data-verdict", column.head}},
                    count == 0 ? "\u00B7" : std::to_string(count));
      }
    });
    out.element("table", {{"class", "lines"}}, [&] {
      out.element("tbody", {}, [&] {
        for (const CoverageStatement& statement : statements)
          write_statement(out, statement, with_results);
      });
    });
  });
  out.markup("\n");
}

void write_manual(HtmlWriter& out, const CoverageManual& manual, const std::vector<Column>& columns,
                  bool with_results) {
  out.element("h2", {}, fmt::format("{}: {}", manual.id, manual.title));
  if (manual.statements.empty()) return out.element("p", {}, "No statements are listed yet.");
  out.element("div", {{"class", "matrix"}, {"style", fmt::format("--columns:{}", columns.size())}},
              [&] {
                out.element("div", {{"class", "head"}}, [&] {
                  out.element("span", {{"class", "name"}}, "section");
                  for (const Column& column : columns) out.element("span", {}, column.head);
                });
                const std::span<const CoverageStatement> all = manual.statements;
                for (std::size_t from = 0, to = 0; from < all.size(); from = to) {
                  while (to < all.size() && all[to].section == all[from].section) ++to;
                  write_section(out, all.subspan(from, to - from),
                                results::title_of(manual.sections, all[from].section), columns,
                                with_results);
                }
              });
}

}  // namespace

std::string coverage_html(const Coverage& coverage) {
  HtmlWriter body;
  write_banner(body, coverage);
  body.element("p", {},
               "Tables are facts without effect on the wire, which `fieldproof lint` checks; a "
               "reason says why no vector can test a statement.");
  const std::vector<Column> columns = columns_of(coverage);
  for (const CoverageManual& manual : coverage.manuals)
    write_manual(body, manual, columns, coverage.with_results());
  return html::html_page("fieldproof: traceability", body);
}

Status write_coverage_html(const Coverage& coverage, const std::string& path) {
  Result<text::ReportFile> file = text::ReportFile::create(path);
  if (!file) return file.error();
  file->out() << coverage_html(coverage);
  return file->commit();
}

}  // namespace fieldproof::reports
