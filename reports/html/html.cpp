#include "reports/html/html.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "reports/html/html_head.hpp"
#include "reports/html/html_page.hpp"
#include "reports/html/html_sheet.hpp"
#include "reports/html/html_survey.hpp"
#include "reports/html/html_timing.hpp"
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
    link(true, "#sections", "Sections");
    link(survey.log.soak.has_value(), "#soak", "Soak");
    link(!survey.response_ms.empty(), "#timing", "Response times");
    link(gate.qualify, "#sheet", "Qualification sheet");
    link(true, "#unexecuted", "Not judged");
    link(true, "#readings", "Readings");
    link(!survey.errata.empty(), "#errata", "Errata");
    link(true, "#hashes", "Hashes");
    link(true, "#legend", "Verdicts");
  });
}

/// What failed again and again, each once; its first cases stand below in full.
void write_findings(HtmlWriter& out, const HtmlSurvey& survey) {
  const std::vector<const text::Finding*> repeated = survey.failures.repeated();
  if (repeated.empty()) return;
  out.element("table", {{"class", "list findings"}}, [&] {
    out.element("tbody", {}, [&] {
      for (const text::Finding* finding : repeated) {
        out.element("tr", {}, [&] {
          out.element("td", {{"class", "num"}}, text::grouped(finding->cases) + " cases");
          out.element("td", {}, [&] {
            out.text((finding->alike ? "" : "alike, as ") + finding->message);
            out.element("small", {{"class", "ids"}}, [&] {
              out.text(" first: ");
              const auto anchor = survey.anchors.find(finding->number);
              const std::string names = fmt::format("{}", fmt::join(finding->first, ", "));
              if (anchor == survey.anchors.end()) return out.text(names);
              out.element("a", {{"href", "#" + anchor->second}}, names);
            });
          });
        });
      }
    });
  });
}

void write_red(HtmlWriter& out, const HtmlSurvey& survey, const results::Gate& gate) {
  const std::size_t count = survey.tally.gating(gate);
  if (count == 0) return;
  out.element("h2", {{"id", "red"}},
              fmt::format("{} case{} turn{} the gate red", count, count == 1 ? "" : "s",
                          count == 1 ? "s" : ""));
  write_findings(out, survey);
  out.markup(survey.broken.str());
  out.markup(survey.red.str());
  if (const std::size_t unjudged =
          gate.qualify ? survey.tally.of(Verdict::blocked) + survey.tally.of(Verdict::inconclusive)
                       : 0;
      unjudged > 0) {
    out.element("p", {}, [&] {
      out.text(
          fmt::format("{} could not be judged, which this gate does not let pass: ", unjudged));
      out.element("a", {{"href", "#unexecuted"}}, "why");
    });
  }
  if (survey.red_unlisted > 0)
    out.element(
        "p", {{"class", "cut"}},
        fmt::format("{} more are listed by their sections; `results.ndjson` has them in full.",
                    survey.red_unlisted));
}

void write_table(HtmlWriter& out, std::string_view css, const HtmlWriter& rows) {
  if (rows.size() > 0)
    out.element("table", {{"class", css}},
                [&] { out.element("tbody", {}, [&] { out.markup(rows.str()); }); });
}

void write_section(HtmlWriter& out, const SectionName& name, const SectionReport& section,
                   const std::vector<Verdict>& columns) {
  out.element("details", {{"class", "section"}}, [&] {
    out.element("summary", {}, [&] {
      out.element("span", {{"class", "name"}},
                  name.section.empty() ? "without a section" : name.section);
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
  out.element("div", {{"class", "matrix"}, {"style", fmt::format("--columns:{}", columns.size())}},
              [&] {
                const std::string* manual = nullptr;
                for (const auto& [name, section] : survey.sections) {
                  if (manual == nullptr || *manual != name.manual) {
                    out.element("div", {{"class", "head"}}, [&] {
                      out.element("span", {{"class", "name"}},
                                  name.manual.empty() ? "no manual" : name.manual);
                      for (Verdict verdict : columns)
                        out.element("span", {}, results::to_string(verdict));
                    });
                  }
                  manual = &name.manual;
                  write_section(out, name, section, columns);
                }
              });
}

double limit_of(const results::RunInfo& run) {
  const auto found = run.properties.find("response_max_ms");
  return found == run.properties.end() ? 0
                                       : std::max(0.0, std::strtod(found->second.c_str(), nullptr));
}

void write_times(HtmlWriter& out, const HtmlSurvey& survey) {
  if (survey.response_ms.empty()) return;
  const double limit = limit_of(survey.log.run);
  out.element("h2", {{"id", "timing"}}, "Response times");
  out.element(
      "p", {},
      fmt::format("From the request's last byte to the reply's first, in milliseconds on a "
                  "logarithmic scale{}. Bars count "
                  "replies (by square root), the line below them spans the middle half, the tick "
                  "is the median.",
                  limit > 0 ? fmt::format("; dashed: the profile's limit of {:g} ms", limit) : ""));
  write_timing(out, survey.response_ms, limit);
}

void write_soak(HtmlWriter& out, const HtmlSurvey& survey) {
  if (!survey.log.soak) return;
  out.element("h2", {{"id", "soak"}}, "Soak");
  out.element("p", {},
              "All repetitions. The cases above are the first of each and, as far as they are "
              "written, those that failed.");
  out.element("pre", {}, results::soak_text(*survey.log.soak));
}

void write_sheet(HtmlWriter& out, const HtmlSurvey& survey, const Gate& gate) {
  out.element("section", {{"id", "sheet"}, {"class", gate.qualify ? "sheet" : "plain"}}, [&] {
    if (gate.qualify) {
      out.element("h1", {}, "Qualification sheet");
      write_verdict_of_run(out, survey, gate);
      write_facts(out, survey, gate);
      const results::RunInfo& run = survey.log.run;
      if (run.duts.empty()) write_fingerprint(out, run.identity);
      for (const results::DutInfo& dut : run.duts) write_fingerprint(out, dut.identity);
    }
    write_unexecuted(out, survey);
    write_readings(out, survey);
    if (!gate.qualify) write_errata(out, survey);
    write_hashes(out, survey);
    if (gate.qualify) write_signatures(out);
  });
  if (gate.qualify) write_errata(out, survey);
}

class HtmlReport final : public Sink {
 public:
  explicit HtmlReport(const std::string& path) : path_(path) {}

  Status begin(const RunInfo& run) override {
    gate_ = text::gate_of(run);
    surveyor_.emplace(gate_);
    return ok();
  }

  Status add(const Delivery& one) override { return surveyor_->add(*one), ok(); }

  Status end(const RunLog& log) override {
    const HtmlSurvey survey = surveyor_->finish(log);
    HtmlWriter body;
    write_verdict_of_run(body, survey, gate_);
    write_facts(body, survey, gate_);
    write_contents(body, survey, gate_);
    write_red(body, survey, gate_);
    write_sections(body, survey);
    write_soak(body, survey);
    write_times(body, survey);
    write_sheet(body, survey, gate_);
    write_legend(body, gate_);
    auto file = ReportFile::create(path_);
    if (!file) return file.error();
    file->out() << html_page("fieldproof: " + device_title(log.run), body);
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
