#include "reports/history/trend_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "reports/compare/compare_statistics.hpp"
#include "reports/history/counts_json.hpp"
#include "reports/history/table.hpp"
#include "reports/text/fold.hpp"

namespace fieldproof::history {

namespace {

constexpr std::size_t console_runs = 20, console_cases = 50;

std::string ms(const std::optional<results::ResponseFigures>& figures,
               double results::ResponseFigures::*which) {
  return figures ? fmt::format("{:.3f}", (*figures).*which) : "-";
}

Table changes_table(const Trend& trend) {
  Table table{{"what", "", "median of the runs", "where", "evidence", "new there"}, {}};
  for (const Series* one : changed(trend))
    table.rows.push_back({one->name, direction_of(*one), shift_of(*one), place_of(trend, *one),
                          evidence_of(*one), cause_of(trend, *one)});
  return table;
}

Table steps_table(const Trend& trend) {
  Table table{{"what", "where"}, {}};
  for (const Step& one : trend.steps)
    table.rows.push_back({one.outcome, between(trend.runs[one.before], trend.runs[one.after])});
  return table;
}

Table flaky_table(const Trend& trend) {
  Table table{{"case", "firmware", "vectors", "verdicts"}, {}};
  for (const FlakyCase& one : trend.flaky)
    table.rows.push_back({one.name, one.firmware, one.vectors, flaky_text(one)});
  return table;
}

Table versions_table(const Trend& trend) {
  Table table{{"firmware", "runs", "first", "last", "median ms", "least", "greatest", "red"}, {}};
  for (const Version& one : versions_of(trend)) {
    const auto [least, greatest] = std::ranges::minmax_element(one.medians);
    const bool timed = !one.medians.empty();
    table.rows.push_back({one.firmware, std::to_string(one.runs), one.first, one.last,
                          timed ? fmt::format("{:.3f}", compare::median(one.medians)) : "-",
                          timed ? fmt::format("{:.3f}", *least) : "-",
                          timed ? fmt::format("{:.3f}", *greatest) : "-",
                          fmt::format("{:g}", compare::median(one.red))});
  }
  return table;
}

/// The newest first: the end of a history is what one looks for.
Table runs_table(const Trend& trend) {
  using results::ResponseFigures;
  Table table{{"run", "started", "firmware", "judged", "red", "replies", "median ms", "p99", "max"},
              {}};
  for (std::size_t i = trend.runs.size(); i-- > 0;) {
    const RunEntry& run = trend.runs[i];
    const auto& figures = trend.replies[i];
    table.rows.push_back({std::to_string(run.number), run.started, run.firmware,
                          std::to_string(run.counts.judged()), std::to_string(run.red),
                          figures ? std::to_string(figures->count) : "-",
                          ms(figures, &ResponseFigures::median), ms(figures, &ResponseFigures::p99),
                          ms(figures, &ResponseFigures::greatest)});
  }
  return table;
}

/// A block for each place.
std::string changes_text(const Trend& trend) {
  std::string text;
  for (const std::vector<const Series*>& place : changed_by_place(trend)) {
    Table table{{"what", "", "median of the runs", "evidence"}, {}};
    for (const Series* one : place)
      table.rows.push_back({one->name, direction_of(*one), shift_of(*one), evidence_of(*one)});
    const std::string cause = cause_of(trend, *place.front());
    text += table_text(fmt::format("changes {}{}", place_of(trend, *place.front()),
                                   cause.empty() ? "" : "; new there: " + cause),
                       table, console_runs, "; --html FILE shows all");
  }
  return text;
}

}  // namespace

std::string direction_of(const Series& series) {
  const bool up = series.change->shift > 0;
  if (series.is_time) return up ? "slower" : "faster";
  return up ? "more" : "fewer";
}

std::string evidence_of(const Series& series) {
  const ChangePoint& change = *series.change;
  const auto text = [](double p) {
    return p < 1e-12 ? std::string("below 1e-12") : fmt::format("{:.2g}", p);
  };
  return fmt::format("p {}, corrected {}, {} runs before and {} after", text(change.p),
                     text(change.corrected_p), change.at, series.values.size() - change.at);
}

std::string trend_head(const Trend& trend) {
  if (trend.runs.empty()) return "no whole run";
  std::string versions;
  for (const Version& one : versions_of(trend))
    if (!one.firmware.empty()) versions += (versions.empty() ? ", firmware " : ", ") + one.firmware;
  return fmt::format(
      "{} {}, {} to {}{}", trend.runs.size(), trend.runs.size() == 1 ? "run" : "runs",
      trend.runs.front().started.substr(0, 10), trend.runs.back().started.substr(0, 10), versions);
}

std::vector<std::string> trend_remarks(const Trend& trend) {
  std::vector<std::string> remarks;
  if (trend.devices > 1)
    remarks.push_back(
        fmt::format("the history has {} devices; --device names another", trend.devices));
  if (trend.older > 0)
    remarks.push_back(fmt::format("{} runs before these are left out (--last)", trend.older));
  if (trend.not_whole > 0)
    remarks.push_back(fmt::format(
        "{} runs that were killed or interrupted, or are shards, are left out", trend.not_whole));
  if (trend.runs.size() < 2 * least_side)
    remarks.push_back(fmt::format(
        "{} runs are too few to test them against each other, {} are needed: neighbours "
        "are compared reply by reply, as `fieldproof compare` does",
        trend.runs.size(), 2 * least_side));
  return remarks;
}

std::string trend_text(const Trend& trend) {
  std::string text = fmt::format("{}\n{}\n", trend.device, trend_head(trend));
  for (const std::string& one : trend_remarks(trend)) text += one + '\n';
  const std::string changes = changes_text(trend);
  text +=
      changes.empty() ? "\nno change in reply times or counts that is more than chance\n" : changes;
  text += text::paragraph(tested_text(trend), 109);
  text += table_text("from run to run", steps_table(trend));
  text += table_text("flaky: same device, firmware and vectors, and yet other verdicts",
                     flaky_table(trend), console_cases, "; --json has all");
  const std::string versions =
      versions_of(trend).size() > 1 ? table_text("by firmware", versions_table(trend)) : "";
  return text + versions +
         table_text("runs", runs_table(trend), console_runs, "; --html FILE shows them");
}

std::string trend_markdown(const Trend& trend) {
  std::string text = fmt::format("# {}\n\n{}\n", trend.device, trend_head(trend));
  for (const std::string& one : trend_remarks(trend)) text += "\n" + one + '\n';
  text += table_markdown("Changes", changes_table(trend));
  text += "\n" + tested_text(trend) + '\n';
  return text + table_markdown("From run to run", steps_table(trend)) +
         table_markdown("Flaky cases", flaky_table(trend)) +
         table_markdown("By firmware", versions_table(trend)) +
         table_markdown("Runs", runs_table(trend));
}

std::string trend_json(const Trend& trend) {
  using nlohmann::ordered_json;
  ordered_json runs = ordered_json::array(), topics = ordered_json::object(),
               changes = ordered_json::array(), steps = ordered_json::array(),
               flaky = ordered_json::array();
  for (std::size_t i = 0; i < trend.runs.size(); ++i) {
    const RunEntry& run = trend.runs[i];
    const auto& figures = trend.replies[i];
    runs.push_back({{"run", run.number},
                    {"started", run.started},
                    {"firmware", run.firmware},
                    {"vectors", run.vectors},
                    {"counts", counts_json(run.counts)},
                    {"red", run.red},
                    {"judged", run.counts.judged()},
                    {"response", figures ? ordered_json{{"replies", figures->count},
                                                        {"min_ms", figures->least},
                                                        {"median_ms", figures->median},
                                                        {"p99_ms", figures->p99},
                                                        {"max_ms", figures->greatest}}
                                         : ordered_json()}});
  }
  for (const Series& one : trend.topics)
    for (std::size_t i = 0; i < one.values.size(); ++i)
      topics[one.name].push_back({trend.runs[one.runs[i]].number, one.values[i]});
  for (const Series* one : changed(trend))
    changes.push_back({{"series", one->name},
                       {"before", one->change->before},
                       {"after", one->change->after},
                       {"shift", one->change->shift},
                       {"p", one->change->p},
                       {"corrected_p", one->change->corrected_p},
                       {"between",
                        {trend.runs[one->runs[one->change->at - 1]].number,
                         trend.runs[one->runs[one->change->at]].number}}});
  for (const Step& one : trend.steps)
    steps.push_back({{"outcome", one.outcome},
                     {"between", {trend.runs[one.before].number, trend.runs[one.after].number}}});
  for (const FlakyCase& one : trend.flaky)
    flaky.push_back({{"id", one.name},
                     {"firmware", one.firmware},
                     {"vectors", one.vectors},
                     {"verdicts", counts_json(one.verdicts)},
                     {"within", one.within}});
  return ordered_json{{"device", trend.device},    {"runs", runs},   {"topics", topics},
                      {"changes", changes},        {"steps", steps}, {"flaky", flaky},
                      {"test", tested_text(trend)}}
             .dump(1) +
         '\n';
}

}  // namespace fieldproof::history
