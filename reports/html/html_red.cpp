#include "reports/html/html_red.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

namespace fieldproof::html {

using results::Verdict;

namespace {

/// How many of a cause are not told in full, and where they are.
void write_rest(HtmlWriter& out, const text::Finding& finding) {
  if (!finding.is_again()) return;
  out.element("p", {{"class", "ids"}},
              fmt::format("{} more are alike; their sections list them",
                          text::grouped(finding.cases - finding.first.size())));
}

void write_cause(HtmlWriter& out, const RedCause& cause) {
  if (cause.finding->cases == 1) return out.markup(cause.group->blocks.str());
  out.element("section", {{"class", "cause"}}, [&] {
    out.element("h3", {}, [&] {
      out.element("b", {{"class", "times"}}, text::grouped(cause.finding->cases) + " \u00D7");
      out.text(" " + cause_text(*cause.finding));
    });
    out.markup(cause.group->blocks.str());
    write_rest(out, *cause.finding);
  });
}

void write_unjudged(HtmlWriter& out, const HtmlSurvey& survey, const results::Gate& gate) {
  const std::size_t unjudged =
      gate.qualify ? survey.tally.of(Verdict::blocked) + survey.tally.of(Verdict::inconclusive) : 0;
  if (unjudged == 0) return;
  out.element("p", {}, [&] {
    out.text(fmt::format("{} could not be judged, which this gate does not let pass: ", unjudged));
    out.element("a", {{"href", "#unexecuted"}}, "why");
  });
}

}  // namespace

std::vector<RedCause> red_causes(const HtmlSurvey& survey) {
  std::vector<RedCause> causes;
  for (const text::Finding* finding : survey.failures.all())
    if (const auto group = survey.red.find(finding->number); group != survey.red.end())
      causes.push_back({finding, &group->second});
  std::ranges::stable_sort(causes, [](const RedCause& a, const RedCause& b) {
    return std::tuple(!a.group->always, b.finding->cases) <
           std::tuple(!b.group->always, a.finding->cases);
  });
  return causes;
}

std::string cause_text(const text::Finding& finding) {
  if (finding.alike) return finding.message;
  std::string cause;
  for (const char c : text::kind_of(finding.message))
    cause += c == '#' ? "\u2026" : std::string(1, c);
  return cause;
}

void write_red(HtmlWriter& out, const HtmlSurvey& survey, const results::Gate& gate) {
  const std::size_t count = survey.tally.gating(gate);
  if (count == 0) return;
  out.element("h2", {{"id", "red"}},
              fmt::format("{} case{} turn{} the gate red", text::grouped(count),
                          count == 1 ? "" : "s", count == 1 ? "s" : ""));
  for (const RedCause& cause : red_causes(survey)) write_cause(out, cause);
  write_unjudged(out, survey, gate);
  if (survey.red_unlisted > 0)
    out.element(
        "p", {{"class", "cut"}},
        fmt::format("{} more are listed by their sections; `results.ndjson` has them in full.",
                    survey.red_unlisted));
}

}  // namespace fieldproof::html
