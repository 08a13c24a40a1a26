#include "reports/html/html.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "reports/html/html_find.hpp"
#include "reports/html/html_head.hpp"
#include "reports/html/html_lists.hpp"
#include "reports/html/html_page.hpp"
#include "reports/html/html_red.hpp"
#include "reports/html/html_sheet.hpp"
#include "reports/html/html_survey.hpp"
#include "reports/html/html_timing.hpp"
#include "reports/html/html_unjudged.hpp"
#include "reports/text/report_file.hpp"

namespace fieldproof::html {

using results::Delivery;
using results::Gate;
using results::RunInfo;
using results::RunLog;
using results::Sink;
using results::Verdict;
using text::ReportFile;

namespace {

std::vector<Verdict> occurring(const text::Tally& tally) {
  std::vector<Verdict> verdicts;
  for (Verdict verdict : text::Tally::verdicts) {
    if (tally.of(verdict) > 0) verdicts.push_back(verdict);
  }
  return verdicts;
}

void write_contents(HtmlWriter& out, const HtmlSurvey& survey, const results::Gate& gate) {
  out.element("nav", {}, [&] {
    const auto link = [&](bool there, std::string_view anchor, std::string_view text) {
      if (there) out.element("a", {{"href", anchor}}, text);
    };
    link(survey.tally.gating(gate) > 0, "#red", "Red");
    link(true, "#unexecuted", "Not judged");
    link(true, "#sections", "Sections");
    link(survey.log.soak.has_value(), "#soak", "Soak");
    link(!survey.response_ms.empty(), "#timing", "Response times");
    link(true, "#readings", "Readings");
    link(!survey.errata.empty(), "#errata", "Errata");
    link(true, "#hashes", "Hashes");
    link(true, "#legend", "Verdicts");
    link(gate.qualify, "#sheet", "Qualification sheet (what is printed)");
  });
}

void write_table(HtmlWriter& out, std::string_view css, const HtmlWriter& rows) {
  if (rows.size() > 0)
    out.element("table", {{"class", css}},
                [&] { out.element("tbody", {}, [&] { out.markup(rows.str()); }); });
}

void write_section(HtmlWriter& out, const SectionName& name, const SectionReport& section,
                   const std::string& title, const std::vector<Verdict>& columns) {
  const std::string number = name.section.empty() ? "without a section" : name.section;
  const std::string where = fmt::format("{}{}{}{}{}", name.manual, name.manual.empty() ? "" : ", ",
                                        number, title.empty() ? "" : " ", title);
  out.element("details", {{"class", "section"}, {"data-section", where}}, [&] {
    out.element("summary", {}, [&] {
      out.element("span", {{"class", "name"}}, [&] {
        out.text(number);
        if (!title.empty()) out.element("i", {}, title);
      });
      for (Verdict verdict : columns) {
        const std::size_t count = section.tally.of(verdict);
        const std::string css = count == 0 ? "none" : verdict_class(verdict);
        out.element("span", {{"class", css}, {"data-verdict", results::to_string(verdict)}},
                    count == 0 ? "\u00B7" : std::to_string(count));
      }
    });
    write_table(out, "lines", section.red);
    out.markup(section.remarkable.str());
    write_table(out, "lines", section.unjudged);
    write_table(out, "passes", section.passes);
    if (section.unlisted > 0)
      out.element("p", {{"class", "cut"}},
                  fmt::format("{} more are counted, not listed; `results.ndjson` has them.",
                              section.unlisted));
  });
  out.markup("\n");
}

/// Section by verdict; each row opens to its cases.
void write_sections(HtmlWriter& out, const HtmlSurvey& survey) {
  const std::vector<Verdict> columns = occurring(survey.tally);
  out.element("h2", {{"id", "sections"}}, "Sections of the manuals");
  out.element(
      "div", {{"class", "matrix"}, {"style", fmt::format("--columns:{}", columns.size())}}, [&] {
        const std::string* manual = nullptr;
        for (const auto& [name, section] : survey.sections) {
          if (manual == nullptr || *manual != name.manual) {
            out.element("div", {{"class", "head"}}, [&] {
              out.element("span", {{"class", "name"}},
                          name.manual.empty() ? "no manual" : name.manual);
              for (Verdict verdict : columns) out.element("span", {}, results::to_string(verdict));
            });
          }
          manual = &name.manual;
          write_section(out, name, section,
                        section_title(survey.log.run.sections, name.manual, name.section), columns);
        }
      });
}

void write_soak(HtmlWriter& out, const HtmlSurvey& survey) {
  if (!survey.log.soak) return;
  out.element("h2", {{"id", "soak"}}, "Soak");
  out.element("p", {},
              "All repetitions. The cases above are the first of each and, as far as they are "
              "written, those that failed.");
  out.element("pre", {}, results::soak_text(*survey.log.soak));
}

/// A place in the page that the list of contents leads to.
void write_place(HtmlWriter& out, std::string_view id, const auto& write) {
  out.element("section", {{"id", id}}, write);
}

class HtmlReport final : public Sink {
 public:
  explicit HtmlReport(const std::string& path) : path_(path) {}

  Status begin(const RunInfo& run) override {
    gate_ = text::gate_of(run);
    surveyor_.emplace(gate_, run.sections);
    return ok();
  }

  Status add(const Delivery& one) override { return surveyor_->add(*one), ok(); }

  Status end(const RunLog& log) override {
    const HtmlSurvey survey = surveyor_->finish(log);
    HtmlWriter body;
    write_verdict_of_run(body, survey, gate_);
    write_facts(body, survey, gate_);
    write_contents(body, survey, gate_);
    write_find(body);
    write_red(body, survey, gate_);
    write_unjudged(body, survey);
    write_sections(body, survey);
    write_soak(body, survey);
    write_place(body, "timing", [&] { write_times(body, survey.response_ms, log.run); });
    write_readings(body, survey);
    write_errata(body, survey);
    write_place(body, "hashes", [&] { write_hashes(body, survey); });
    write_legend(body, gate_);
    if (gate_.qualify) write_sheet(body, survey, gate_);
    auto file = ReportFile::create(path_);
    if (!file) return file.error();
    file->out() << html_page("fieldproof: " + device_title(log.run), body, html_script);
    return file->commit();
  }

 private:
  std::string path_;
  Gate gate_;
  std::optional<HtmlSurveyor> surveyor_;  // from the beginning on
};

}  // namespace

std::unique_ptr<Sink> html_report(const std::string& path) {
  return std::make_unique<HtmlReport>(path);
}

}  // namespace fieldproof::html
