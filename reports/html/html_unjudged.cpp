#include "reports/html/html_unjudged.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <map>
#include <span>

#include "reports/html/html_page.hpp"
#include "reports/text/remedy.hpp"
#include "reports/text/run_text.hpp"

namespace fieldproof::html {

using results::Verdict;

namespace {

constexpr std::size_t group_limit = 200, reason_limit = 40;  // shown on screen
constexpr std::size_t line_limit = 40;                       // on paper
constexpr std::size_t paper_line = 110;                      // characters

constexpr std::array unjudged_verdicts = {Verdict::blocked, Verdict::inconclusive, Verdict::skip};

const char* heading(Verdict verdict) {
  switch (verdict) {
    case Verdict::blocked: return "blocked, by what would let them run";
    case Verdict::inconclusive: return "inconclusive: the bench cannot judge";
    default: return "skipped: outside the profile of the device";
  }
}

std::string or_nothing(const std::string& reason) {
  return reason.empty() ? "no reason given" : reason.substr(0, 500);
}

std::string joined(const Unexecuted& one) {
  const std::string ids = fmt::format("{}", fmt::join(one.ids, ", "));
  return one.cases > one.ids.size()
             ? fmt::format("{}, and {} more", ids, one.cases - one.ids.size())
             : ids;
}

void write_reasons(HtmlWriter& out, const UnjudgedGroup& group) {
  std::size_t shown = 0;
  for (const auto& [reason, unexecuted] : group.reasons) {
    if (++shown > reason_limit) break;
    out.element("p", {{"class", "reason"}}, [&] {
      if (reason != group.what)
        out.text(fmt::format("{} \u00D7 {}", unexecuted->cases, or_nothing(reason)));
      out.element("span", {{"class", "ids"}}, joined(*unexecuted));
    });
  }
  if (group.reasons.size() > reason_limit)
    out.element("p", {}, fmt::format("... {} more reasons", group.reasons.size() - reason_limit));
}

void write_group(HtmlWriter& out, const UnjudgedGroup& group, Verdict verdict) {
  out.element("tr", {}, [&] {
    out.element("td", {{"class", "num " + verdict_class(verdict)}}, text::grouped(group.cases));
    out.element("td", {}, [&] {
      out.element("details", {}, [&] {
        out.element("summary", {}, or_nothing(group.what));
        write_reasons(out, group);
      });
    });
  });
}

void write_line(HtmlWriter& out, Verdict verdict, std::size_t cases, std::string what) {
  if (what.size() > paper_line) what = what.substr(0, what.rfind(' ', paper_line)) + " ...";
  out.element("tr", {}, [&] {
    out.element("td", {}, [&] { write_verdict(out, verdict); });
    out.element("td", {{"class", "num"}}, text::grouped(cases));
    out.element("td", {}, what);
  });
}

}  // namespace

std::vector<UnjudgedGroup> unjudged_groups(const HtmlSurvey& survey, Verdict verdict) {
  std::map<std::string, UnjudgedGroup> by_what;
  for (const auto& [key, unexecuted] : survey.unexecuted) {
    if (key.first != verdict) continue;
    const std::string what = verdict == Verdict::blocked ? text::remedy_of(key.second) : key.second;
    UnjudgedGroup& group = by_what[what];
    group.what = what;
    group.cases += unexecuted.cases;
    group.reasons.emplace_back(key.second, &unexecuted);
  }
  std::vector<UnjudgedGroup> groups;
  for (auto& [what, group] : by_what) {
    std::ranges::stable_sort(group.reasons, std::greater<>{},
                             [](const auto& reason) { return reason.second->cases; });
    groups.push_back(std::move(group));
  }
  std::ranges::stable_sort(groups, std::greater<>{}, &UnjudgedGroup::cases);
  return groups;
}

void write_unjudged(HtmlWriter& out, const HtmlSurvey& survey) {
  out.element("h2", {{"id", "unexecuted"}}, "Not judged, and why");
  if (survey.unexecuted.empty())
    return out.element("p", {}, "Every selected case was executed and judged.");
  for (const Verdict verdict : unjudged_verdicts) {
    const std::vector<UnjudgedGroup> groups = unjudged_groups(survey, verdict);
    if (groups.empty()) continue;
    out.element("h3", {}, [&] {
      write_verdict(out, verdict);
      out.text(fmt::format(" {} {}", text::grouped(survey.tally.of(verdict)), heading(verdict)));
    });
    out.element("table", {{"class", "list unjudged"}}, [&] {
      out.element("tbody", {}, [&] {
        for (const UnjudgedGroup& group :
             std::span(groups).first(std::min(groups.size(), group_limit)))
          write_group(out, group, verdict);
      });
    });
    if (groups.size() > group_limit)
      out.element("p", {}, fmt::format("... {} more reasons", groups.size() - group_limit));
  }
}

void write_unjudged_lines(HtmlWriter& out, const HtmlSurvey& survey) {
  if (survey.unexecuted.empty())
    return out.element("p", {}, "Every selected case was executed and judged.");
  out.element("table", {{"class", "list one-line"}}, [&] {
    out.element("tbody", {}, [&] {
      for (const Verdict verdict : {Verdict::blocked, Verdict::inconclusive}) {
        const std::vector<UnjudgedGroup> groups = unjudged_groups(survey, verdict);
        std::size_t rest = 0, shown = 0;
        for (const UnjudgedGroup& group : groups) {
          if (++shown <= line_limit)
            write_line(out, verdict, group.cases, or_nothing(group.what));
          else
            rest += group.cases;
        }
        if (rest > 0) write_line(out, verdict, rest, "further reasons; the report has them");
      }
      if (const std::size_t skipped = survey.tally.of(Verdict::skip); skipped > 0)
        write_line(out, Verdict::skip, skipped,
                   "other models and protocols: outside the profile of the device");
    });
  });
}

}  // namespace fieldproof::html
