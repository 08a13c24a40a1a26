#include "reports/history/trend_html.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "reports/compare/compare_statistics.hpp"
#include "reports/history/trend_plot.hpp"
#include "reports/history/trend_text.hpp"
#include "reports/html/html_page.hpp"

namespace fieldproof::history {

using html::HtmlWriter;
using text::grouped;

namespace {

constexpr std::size_t most_runs = 1000;   // rows; the curves show all
constexpr std::size_t most_flaky = 200;   // the others are counted
constexpr std::size_t most_in_sight = 6;  // changes of a place, and curves; the others are folded

void write_table(HtmlWriter& out, std::initializer_list<std::string_view> head, const auto& rows) {
  out.element("div", {{"class", "scroll"}}, [&] {
    out.element("table", {{"class", "list"}}, [&] {
      out.element("thead", {}, [&] {
        out.element("tr", {}, [&] {
          for (const std::string_view name : head) out.element("th", {}, name);
        });
      });
      out.element("tbody", {}, rows);
    });
  });
}

void write_row(HtmlWriter& out, std::initializer_list<std::string> cells) {
  out.element("tr", {}, [&] {
    for (const std::string& cell : cells) out.element("td", {}, cell);
  });
  out.markup("\n");
}

void write_head(HtmlWriter& out, const Trend& trend, const std::string& title) {
  const bool worse = std::ranges::any_of(changed(trend), [](const Series* one) {
    return (one->change->shift > 0) == (one->name != "judged");
  });
  out.element(
      "div", {{"class", worse || !trend.flaky.empty() ? "banner bad" : "banner good"}}, [&] {
        out.element("p", {{"class", "device"}}, "fieldproof history trend: " + trend.device);
        out.element("h1", {}, title);
        out.element("p", {{"class", "detail"}}, trend_head(trend));
        for (const std::string& one : trend_remarks(trend))
          out.element("p", {{"class", "device"}}, one);
      });
}

void write_change(HtmlWriter& out, const Series& one) {
  const bool bad = (one.change->shift > 0) == (one.name != "judged");
  out.element("p", {}, [&] {
    out.element("span", {{"class", bad ? "verdict v-fail" : "verdict v-pass"}}, direction_of(one));
    out.text(" ");
    out.element("b", {}, one.name);
    out.text(": " + shift_of(one));
    out.element("small", {}, evidence_of(one));
  });
}

void write_place(HtmlWriter& out, const Trend& trend, const std::vector<const Series*>& place) {
  const std::string cause = cause_of(trend, *place.front());
  out.element("h3", {}, place_of(trend, *place.front()));
  if (!cause.empty()) out.element("p", {}, "new there: " + cause);
  const std::size_t shown = std::min(most_in_sight, place.size());
  for (std::size_t i = 0; i < shown; ++i) write_change(out, *place[i]);
  if (shown == place.size()) return;
  out.element("details", {}, [&] {
    out.element("summary", {}, fmt::format("{} more at this place", place.size() - shown));
    for (std::size_t i = shown; i < place.size(); ++i) write_change(out, *place[i]);
  });
}

void write_changes(HtmlWriter& out, const Trend& trend) {
  out.element("h2", {}, "Changes");
  const auto places = changed_by_place(trend);
  if (places.empty()) out.element("p", {}, "None that is more than chance.");
  for (const std::vector<const Series*>& place : places) write_place(out, trend, place);
  for (const Step& one : trend.steps)
    out.element("p", {}, [&] {
      out.element("b", {}, one.outcome);
      out.text(' ' + between(trend.runs[one.before], trend.runs[one.after]));
    });
  out.element("small", {}, tested_text(trend));
}

void write_topics(HtmlWriter& out, const Trend& trend) {
  std::vector<const Series*> in_sight, others;
  for (const Series& one : trend.topics)
    (one.change && in_sight.size() < most_in_sight ? in_sight : others).push_back(&one);
  for (const Series* one : in_sight) write_trend_plot(out, trend, *one);
  if (others.empty()) return;
  out.element("details", {}, [&] {
    out.element("summary", {},
                fmt::format("reply times of {} {}groups of cases", others.size(),
                            in_sight.empty() ? "" : "more "));
    for (const Series* one : others) write_trend_plot(out, trend, *one);
  });
}

void write_flaky(HtmlWriter& out, const Trend& trend) {
  if (trend.flaky.empty()) return;
  out.element("h2", {}, fmt::format("{} flaky cases", grouped(trend.flaky.size())));
  out.element("p", {}, "Same device, firmware and vectors, and yet other verdicts.");
  const std::size_t shown = std::min(most_flaky, trend.flaky.size());
  write_table(out, {"Case", "Firmware", "Vectors", "Verdicts"}, [&] {
    for (const FlakyCase& one : std::span(trend.flaky).first(shown)) {
      out.element("tr", {}, [&] {
        out.element("th", {}, [&] { out.element("code", {}, one.name); });
        for (const std::string& cell : {one.firmware, one.vectors, flaky_text(one)})
          out.element("td", {}, cell);
      });
      out.markup("\n");
    }
  });
  if (shown < trend.flaky.size())
    out.element("p", {},
                fmt::format("{} more, less often: `fieldproof history trend --json` has them.",
                            grouped(trend.flaky.size() - shown)));
}

void write_versions_table(HtmlWriter& out, const Trend& trend) {
  const std::vector<Version> versions = versions_of(trend);
  if (versions.size() < 2) return;
  out.element("h2", {}, "By firmware");
  write_table(out, {"Firmware", "Runs", "First", "Last", "Median ms", "Red"}, [&] {
    for (const Version& one : versions)
      write_row(out, {one.firmware, std::to_string(one.runs), one.first, one.last,
                      one.medians.empty() ? "\u2013"
                                          : fmt::format("{:.3f}", compare::median(one.medians)),
                      fmt::format("{:g}", compare::median(one.red))});
  });
}

void write_runs(HtmlWriter& out, const Trend& trend) {
  out.element("h2", {}, "Runs");
  const std::size_t shown = std::min(most_runs, trend.runs.size());
  out.element("details", {}, [&] {
    out.element("summary", {},
                shown < trend.runs.size()
                    ? fmt::format("the last {} of {}", grouped(shown), grouped(trend.runs.size()))
                    : fmt::format("{} runs, the last first", shown));
    write_table(
        out, {"Run", "Started", "Firmware", "Results", "Replies", "Median ms", "99 %"}, [&] {
          for (std::size_t n = 0; n < shown; ++n) {
            const std::size_t i = trend.runs.size() - 1 - n;
            const RunEntry& run = trend.runs[i];
            const auto& figures = trend.replies[i];
            write_row(out, {std::to_string(run.number), run.started, run.firmware,
                            to_string(run.counts), figures ? grouped(figures->count) : "\u2013",
                            figures ? fmt::format("{:.3f}", figures->median) : "\u2013",
                            figures ? fmt::format("{:.3f}", figures->p99) : "\u2013"});
          }
        });
  });
}

}  // namespace

std::string trend_html(const Trend& trend) {
  const std::size_t changes = changed(trend).size();
  std::string title = changes == 0 ? "No change" : fmt::format("{} changes", changes);
  if (changes == 1) title = "1 change";
  if (!trend.flaky.empty())
    title += fmt::format(", {} flaky {}", grouped(trend.flaky.size()),
                         trend.flaky.size() == 1 ? "case" : "cases");
  HtmlWriter body;
  write_head(body, trend, title);
  write_changes(body, trend);
  if (!trend.runs.empty()) {
    body.element("h2", {}, "Over the runs");
    for (const Series& one : trend.totals) write_trend_plot(body, trend, one);
    write_topics(body, trend);
  }
  write_flaky(body, trend);
  write_versions_table(body, trend);
  write_runs(body, trend);
  return html::html_page("fieldproof history: " + title, body);
}

}  // namespace fieldproof::history
