#include "reports/html/html_sheet.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>

#include "reports/html/html_head.hpp"
#include "reports/html/html_lists.hpp"
#include "reports/html/html_page.hpp"
#include "reports/html/html_red.hpp"
#include "reports/html/html_timing.hpp"
#include "reports/html/html_unjudged.hpp"

namespace fieldproof::html {

using results::Verdict;

namespace {

constexpr std::size_t cause_limit = 40;  // more are counted

std::string value_or(const std::map<std::string, std::string>& map, const std::string& key,
                     const char* otherwise) {
  const auto found = map.find(key);
  return found == map.end() ? otherwise : found->second;
}

void write_fingerprint(HtmlWriter& out, const results::Identity& identity) {
  out.element("h2", {}, identity.name.empty() ? "Fingerprint" : "Fingerprint of " + identity.name);
  if (identity.fingerprint.empty() && identity.fingerprint_found.empty()) {
    out.element(
        "p", {},
        "None was declared and none was read: the identity above is as the engineer entered it.");
    return;
  }
  std::map<std::string, std::string> keys = identity.fingerprint;
  keys.insert(identity.fingerprint_found.begin(), identity.fingerprint_found.end());
  out.element("table", {{"class", "list"}}, [&] {
    write_head_row(out, {"", "declared", "found"});
    out.element("tbody", {}, [&] {
      for (const auto& [key, any] : keys) {
        const std::string declared = value_or(identity.fingerprint, key, "not declared");
        const std::string found = value_or(identity.fingerprint_found, key, "not read");
        out.element("tr", {}, [&] {
          out.element("th", {}, key);
          out.element("td", {}, declared);
          out.element("td", {},
                      !identity.fingerprint.contains(key) || declared == found
                          ? found
                          : found + " (differs)");
        });
      }
    });
  });
}

void write_signatures(HtmlWriter& out) {
  out.element("div", {{"class", "signatures"}}, [&] {
    for (const char* role : {"Tested by", "Approved by"}) {
      out.element("div", {}, [&] {
        out.element("b", {}, role);
        for (const char* field : {"Name", "Date", "Signature"}) out.element("p", {}, field);
      });
    }
  });
}

/// What failed, a line a cause.
void write_causes(HtmlWriter& out, const HtmlSurvey& survey) {
  const std::vector<RedCause> causes = red_causes(survey);
  if (causes.empty()) return;
  out.element("h2", {}, "What turned the gate red");
  out.element("table", {{"class", "list"}}, [&] {
    write_head_row(out, {"cases", "cause", "first"});
    out.element("tbody", {}, [&] {
      for (std::size_t i = 0; i < std::min(causes.size(), cause_limit); ++i)
        out.element("tr", {}, [&] {
          const text::Finding& finding = *causes[i].finding;
          out.element("td", {{"class", "num"}}, text::grouped(finding.cases));
          out.element("td", {}, cause_text(finding));
          out.element("td", {{"class", "ids"}}, finding.first.front());
        });
    });
  });
  if (causes.size() > cause_limit)
    out.element("p", {}, fmt::format("... {} more causes", causes.size() - cause_limit));
}

/// A chapter's part of a manual.
struct Part {
  std::string manual, number, title;
  text::Tally tally;
};
std::vector<Part> parts_of(const HtmlSurvey& survey) {
  std::vector<Part> parts;
  for (const auto& [name, section] : survey.sections) {
    const std::string number = results::part_of(name.section);
    if (parts.empty() || parts.back().manual != name.manual || parts.back().number != number)
      parts.push_back(
          {name.manual, number, section_title(survey.log.run.sections, name.manual, number), {}});
    parts.back().tally.add(section.tally);
  }
  return parts;
}

/// Each part of a manual by verdict, SKIP apart: what is not of this device is no line of its
/// sheet.
void write_parts(HtmlWriter& out, const HtmlSurvey& survey) {
  std::vector<Verdict> columns;
  for (const Verdict verdict : text::Tally::verdicts)
    if (verdict != Verdict::skip && survey.tally.of(verdict) > 0) columns.push_back(verdict);
  out.element("h2", {}, "By section of the manuals");
  out.element("table", {{"class", "list parts"}}, [&] {
    out.element("thead", {}, [&] {
      out.element("tr", {}, [&] {
        for (const char* head : {"manual", "section", ""}) out.element("th", {}, head);
        for (const Verdict verdict : columns)
          out.element("th", {{"class", "num"}}, results::to_string(verdict));
      });
    });
    out.element("tbody", {}, [&] {
      for (const Part& part : parts_of(survey)) {
        if (part.tally.applicable() == 0) continue;
        out.element("tr", {}, [&] {
          for (const std::string* text : {&part.manual, &part.number, &part.title})
            out.element("td", {}, *text);
          for (const Verdict verdict : columns) {
            const std::size_t count = part.tally.of(verdict);
            out.element("td", {{"class", "num"}},
                        count == 0 ? std::string("\u00B7") : text::grouped(count));
          }
        });
      }
    });
  });
}

/// Those that the cases of this run met, by their names; the report has what they are.
void write_met(HtmlWriter& out, const HtmlSurvey& survey) {
  if (!survey.readings.empty()) {
    out.element("h2", {}, "Readings taken");
    out.element("p", {{"class", "ids"}}, [&] {
      std::string text;
      for (const auto& [name, taken] : survey.readings)
        for (const auto& [choice, reading] : taken)
          text += fmt::format("{}{} = {} ({}{})", text.empty() ? "" : "; ", name, choice,
                              text::grouped(reading.cases), taken.size() > 1 ? ", mixed" : "");
      out.text(text);
    });
  }
  if (survey.errata.empty()) return;
  std::map<std::string, std::size_t> kinds;
  for (const auto& [erratum, tally] : survey.errata) ++kinds[erratum.kind];
  std::string text = fmt::format("{} mistakes of the manuals, judged by what is right: ",
                                 text::grouped(survey.errata.size()));
  for (const auto& [kind, count] : kinds)
    text += fmt::format("{}{} {}", kind == kinds.begin()->first ? "" : ", ", count, kind);
  out.element("h2", {}, "Errata of the manuals met");
  out.element("p", {}, text + ". The report and `fieldproof errata` have each.");
}

/// By protocol: a line a group of cases would fill pages.
void write_protocol_times(HtmlWriter& out, const HtmlSurvey& survey) {
  std::map<std::string, results::ResponseTimes> by_protocol;
  for (const auto& [group, times] : survey.response_ms)
    by_protocol[group.substr(0, group.find('/'))].add(times);
  write_times(out, by_protocol, survey.log.run);
}

void write_first_page(HtmlWriter& out, const HtmlSurvey& survey, const results::Gate& gate) {
  out.element("h1", {}, "Qualification sheet");
  write_verdict_of_run(out, survey, gate);
  write_facts(out, survey, gate);
  write_signatures(out);
  write_hashes(out, survey);
}

}  // namespace

void write_sheet(HtmlWriter& out, const HtmlSurvey& survey, const results::Gate& gate) {
  out.element("section", {{"id", "sheet"}, {"class", "sheet"}}, [&] {
    write_first_page(out, survey, gate);
    out.element("h2", {{"class", "page"}}, "Not judged, and why");
    write_unjudged_lines(out, survey);
    write_causes(out, survey);
    write_parts(out, survey);
    write_protocol_times(out, survey);
    write_met(out, survey);
    const results::RunInfo& run = survey.log.run;
    if (run.duts.empty()) write_fingerprint(out, run.identity);
    for (const results::DutInfo& dut : run.duts) write_fingerprint(out, dut.identity);
  });
}

}  // namespace fieldproof::html
