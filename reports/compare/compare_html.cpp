#include "reports/compare/compare_html.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "reports/compare/compare_text.hpp"
#include "reports/html/html_page.hpp"
#include "reports/text/report_file.hpp"
#include "reports/text/xml_text.hpp"

namespace fieldproof::compare {

using html::HtmlWriter;

namespace {

void write_cell(HtmlWriter& out, const CaseSummary* summary) {
  out.element("td", {}, [&] {
    if (!summary) return out.text("\u2013");
    html::write_verdict(out, summary->verdict);
    if (summary->with_verdict < summary->repetitions)
      out.element("small", {},
                  fmt::format("{} of {}", summary->with_verdict, summary->repetitions));
  });
}

void write_head(HtmlWriter& out, std::initializer_list<std::string_view> names) {
  out.element("thead", {}, [&] {
    out.element("tr", {}, [&] {
      for (const std::string_view name : names) out.element("th", {}, name);
    });
  });
}

/// A long list is folded, so that what comes after it is in sight.
template <typename Body>
void write_folded(HtmlWriter& out, bool open, const std::string& summary, const Body& body) {
  const auto inside = [&] {
    out.element("summary", {}, [&] { out.element("b", {}, summary); });
    body();
  };
  if (open)
    out.element("details", {{"open", "open"}}, inside);
  else
    out.element("details", {}, inside);
}

std::string pair_name(std::size_t i) {
  return ComparisonSet::letter(0) + " to " + ComparisonSet::letter(i + 1);
}

void write_banner(HtmlWriter& out, const ComparisonSet& set) {
  out.element("div", {{"class", set.worse() ? "banner bad" : "banner good"}}, [&] {
    out.element("p", {{"class", "device"}}, "fieldproof compare");
    out.element("h1", {}, set.worse() ? "something got worse" : "nothing got worse");
    for (std::size_t i = 0; i < set.comparisons.size(); ++i) {
      const Comparison& one = set.comparisons[i];
      out.element("p", {{"class", "detail"}},
                  fmt::format("{}: {}; {} of {} cases unchanged", pair_name(i), outcome(one),
                              one.unchanged, one.unchanged + one.changes.size()));
    }
  });
}

void write_runs(HtmlWriter& out, const ComparisonSet& set) {
  out.element("table", {{"class", "list"}}, [&] {
    write_head(out, {"", "Run", "Results"});
    out.element("tbody", {}, [&] {
      for (std::size_t i = 0; i < set.runs.size(); ++i) {
        const RunSummary& run = set.runs[i];
        out.element("tr", {}, [&] {
          out.element("th", {}, ComparisonSet::letter(i));
          out.element("td", {}, [&] {
            out.element("code", {}, run.path);
            out.element("small", {}, run_facts(run));
          });
          out.element("td", {},
                      fmt::format("{}: {}", run.tally.total(), text::to_string(run.tally)));
        });
      }
    });
  });
}

void write_change(HtmlWriter& out, const CaseChange& change) {
  out.element("tr", {}, [&] {
    out.element("th", {}, [&] {
      out.element("code", {}, change.id);
      out.element("small", {}, (change.after ? change.after : change.before)->title);
    });
    write_cell(out, change.before);
    write_cell(out, change.after);
    out.element("td", {}, [&] {
      const auto message = [&](const CaseSummary* summary, const char* when) {
        if (summary && !summary->message.empty())
          out.element("p", {}, fmt::format("{}: {}", when, summary->message));
      };
      message(change.before, "before");
      message(change.after, "now");
      if (change.change == Change::revised)
        out.element("p", {}, fmt::format("rev {} to {}", change.before->rev, change.after->rev));
    });
  });
  out.markup("\n");
}

void write_changes(HtmlWriter& out, const Comparison& comparison, std::size_t index) {
  const std::string before = ComparisonSet::letter(0), after = ComparisonSet::letter(index + 1);
  auto next = comparison.changes.begin();
  for (Change kind : all_changes) {
    const std::size_t count = comparison.count(kind);
    if (count == 0) continue;
    const bool told_first = kind <= Change::other_reason;
    write_folded(out, told_first, fmt::format("{} {}: {}", count, to_string(kind), meaning(kind)),
                 [&] {
                   out.element("table", {{"class", "list"}}, [&] {
                     write_head(out, {"Case", before, after, "What was said"});
                     out.element("tbody", {}, [&] {
                       for (std::size_t i = 0; i < count; ++i, ++next) write_change(out, *next);
                     });
                   });
                 });
  }
}

void write_times(HtmlWriter& out, const Comparison& comparison) {
  const TimingTest& timing = comparison.timing;
  if (timing.tested + timing.too_few == 0) return;
  out.element("h3", {}, "Reply times");
  if (comparison.shifts.empty())
    out.element("p", {}, timing.tested > 0 ? "No shift that is more than chance." : "Not tested.");
  else
    out.element("table", {{"class", "list"}}, [&] {
      write_head(out, {"", "Case", "Medians and shift"});
      out.element("tbody", {}, [&] {
        for (const TimeShift& shift : comparison.shifts) {
          out.element("tr", {}, [&] {
            const bool slower = shift.shift_ms > 0;
            out.element("td", {}, [&] {
              out.element("span", {{"class", slower ? "verdict v-fail" : "verdict v-pass"}},
                          slower ? "slower" : "faster");
            });
            out.element("th", {}, [&] { out.element("code", {}, shift.id); });
            out.element("td", {}, shift_text(shift));
          });
          out.markup("\n");
        }
      });
    });
  out.element("small", {}, describe(timing));
}

template <typename Rows>
void write_matrix_table(HtmlWriter& out, const ComparisonSet& set, const Rows& rows) {
  out.element("table", {{"class", "list"}}, [&] {
    out.element("thead", {}, [&] {
      out.element("tr", {}, [&] {
        out.element("th", {}, "Case");
        for (std::size_t i = 0; i < set.runs.size(); ++i)
          out.element("th", {}, ComparisonSet::letter(i));
      });
    });
    out.element("tbody", {}, [&] {
      for (const MatrixRow& row : rows) {
        out.element("tr", {}, [&] {
          out.element("th", {}, [&] { out.element("code", {}, row.id); });
          for (const CaseSummary* cell : row.cells) write_cell(out, cell);
        });
        out.markup("\n");
      }
    });
  });
}

void write_matrix(HtmlWriter& out, const ComparisonSet& set) {
  out.element("h2", {}, "Cases by run");
  const auto same = std::ranges::find(set.rows, false, &MatrixRow::differs);
  const auto differing = std::ranges::subrange(set.rows.begin(), same);
  const auto equal = std::ranges::subrange(same, set.rows.end());
  if (differing.empty())
    out.element("p", {}, "No case differs.");
  else
    write_matrix_table(out, set, differing);
  if (!equal.empty())
    write_folded(out, false, fmt::format("{} cases alike in all runs", equal.size()),
                 [&] { write_matrix_table(out, set, equal); });
}

}  // namespace

Status write_compare_html(const ComparisonSet& set, const std::string& path) {
  HtmlWriter body;
  write_banner(body, set);
  write_runs(body, set);
  for (std::size_t i = 0; i < set.comparisons.size(); ++i) {
    const Comparison& one = set.comparisons[i];
    body.element("h2", {}, pair_name(i) + ": " + outcome(one));
    write_changes(body, one, i);
    write_times(body, one);
  }
  write_matrix(body, set);
  auto file = text::ReportFile::create(path);
  if (!file) return file.error();
  file->out() << html::html_page("fieldproof compare: " + outcome(set.comparisons.back()), body);
  return file->commit();
}

}  // namespace fieldproof::compare
