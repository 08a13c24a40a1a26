#include "reports/history/trend.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <unordered_map>

#include "reports/compare/compare.hpp"
#include "reports/history/device_choice.hpp"

namespace fieldproof::history {

using results::ResponseFigures;

namespace {

void add_point(Series& series, std::size_t run, double value) {
  series.runs.push_back(run);
  series.values.push_back(value);
}

/// The runs that count, of those of the device.
void choose_runs(std::vector<RunEntry> all, std::size_t last, Trend& trend) {
  for (RunEntry& run : all) {
    if (run.complete)
      trend.runs.push_back(std::move(run));
    else
      ++trend.not_ended;
  }
  if (last == 0 || trend.runs.size() <= last) return;
  trend.older = trend.runs.size() - last;
  trend.runs.erase(trend.runs.begin(), trend.runs.end() - static_cast<std::ptrdiff_t>(last));
}

/// Reply times of each run, by topic; most runs of an emulator share theirs.
Status add_times(History& history, Trend& trend) {
  std::unordered_map<std::int64_t, std::vector<TopicFigures>> known;
  std::unordered_map<std::int64_t, std::string> names;
  std::map<std::string, Series> topics;
  std::unordered_map<std::int64_t, Series*> series_of;
  for (std::size_t i = 0; i < trend.runs.size(); ++i) {
    const auto [entry, is_new] = known.try_emplace(trend.runs[i].topics);
    if (is_new) {
      const Result<Numbers> numbers = history.list(trend.runs[i].topics);
      if (!numbers) return numbers.error();
      auto figures = topics_from(*numbers);
      if (!figures) return fail("cannot read history " + history.path() + ": it is damaged");
      entry->second = std::move(*figures);
    }
    trend.replies.emplace_back();
    for (const TopicFigures& one : entry->second) {
      Series*& series = series_of[one.name];
      if (!series) {
        const Result<std::string> name = history.text(one.name);
        if (!name) return name.error();
        series = &topics[*name];
        series->name = *name;
      }
      if (series->name.empty()) trend.replies.back() = one.figures;
      add_point(*series, i, one.figures.median);
    }
  }
  for (auto& [name, series] : topics) {
    const bool all = name.empty();
    if (all) series.name = "reply times";
    (all ? trend.totals : trend.topics).push_back(std::move(series));
  }
  return ok();
}

void add_counts(Trend& trend) {
  Series red{"red", false, {}, {}, {}}, judged{"judged", false, {}, {}, {}};
  for (std::size_t i = 0; i < trend.runs.size(); ++i) {
    add_point(red, i, static_cast<double>(trend.runs[i].red));
    add_point(judged, i, static_cast<double>(trend.runs[i].counts.judged()));
  }
  trend.totals.push_back(std::move(red));
  trend.totals.push_back(std::move(judged));
}

/// Totals and topics are two families: a device that became slower as a whole is seen in few runs.
void find_changes(std::vector<Series>& family, std::size_t& tested) {
  std::vector<std::vector<double>> values;
  for (const Series& series : family) values.push_back(series.values);
  using compare::TimingTest;
  auto changes = change_points(values, {TimingTest::least_ms, TimingTest::least_share}, tested);
  for (std::size_t i = 0; i < family.size(); ++i) family[i].change = std::move(changes[i]);
}

/// What `compare` says of each run and the next.
Status add_steps(History& history, Trend& trend) {
  if (trend.runs.size() >= 2 * least_side) return ok();
  std::optional<compare::RunSummary> before;
  for (std::size_t i = 0; i < trend.runs.size(); ++i) {
    Result<compare::RunSummary> after = history.summary(trend.runs[i].number);
    if (!after) return after.error();
    if (before) {
      const compare::Comparison one = compare::compare(*before, *after);
      const std::size_t faster = one.shifts.size() - one.slower();
      std::string outcome = one.worse() ? compare::outcome(one) : "";
      for (const auto& [count, what] : {std::pair(one.count(compare::Change::newly_passing),
                                                  to_string(compare::Change::newly_passing)),
                                        std::pair(faster, std::string("faster"))})
        if (count > 0) outcome += fmt::format("{}{} {}", outcome.empty() ? "" : ", ", count, what);
      if (!outcome.empty()) trend.steps.push_back({i - 1, i, std::move(outcome)});
    }
    before = std::move(*after);
  }
  return ok();
}

const RunEntry& run_before(const Trend& trend, const Series& series) {
  return trend.runs[series.runs[series.change->at - 1]];
}

const RunEntry& run_after(const Trend& trend, const Series& series) {
  return trend.runs[series.runs[series.change->at]];
}

std::string run_name(const RunEntry& run) {
  return fmt::format("run {} ({}{}{})", run.number, run.firmware, run.firmware.empty() ? "" : ", ",
                     run.started.substr(0, 10));
}

}  // namespace

Result<Trend> trend_of(History& history, const std::string& device, std::size_t last) {
  Result<std::vector<RunEntry>> all = history.runs();
  if (!all) return all.error();
  if (all->empty())
    return fail(fmt::format("history {} has no run yet; `fieldproof history add RESULT` adds one",
                            history.path()));
  Trend trend;
  trend.devices = devices_of(*all).size();
  const Result<std::string> chosen =
      device.empty() ? Result<std::string>(all->back().device) : find_device(*all, device);
  if (!chosen) return chosen.error();
  trend.device = *chosen;
  std::erase_if(*all, [&](const RunEntry& run) { return run.device != trend.device; });
  choose_runs(std::move(*all), last, trend);
  if (const Status added = add_times(history, trend); !added) return added.error();
  add_counts(trend);
  find_changes(trend.totals, trend.tested_totals);
  find_changes(trend.topics, trend.tested_topics);
  Result<std::vector<FlakyCase>> flaky = flaky_cases(history, trend.runs);
  if (!flaky) return flaky.error();
  trend.flaky = std::move(*flaky);
  if (const Status added = add_steps(history, trend); !added) return added.error();
  return trend;
}

std::vector<const Series*> changed(const Trend& trend) {
  std::vector<const Series*> found;
  for (const auto* family : {&trend.totals, &trend.topics})
    for (const Series& series : *family)
      if (series.change) found.push_back(&series);
  return found;
}

std::vector<std::vector<const Series*>> changed_by_place(const Trend& trend) {
  std::vector<std::vector<const Series*>> places;
  for (const Series* one : changed(trend)) {
    const auto same = std::ranges::find_if(places, [&](const auto& place) {
      return place_of(trend, *place.front()) == place_of(trend, *one);
    });
    if (same == places.end())
      places.push_back({one});
    else
      same->push_back(one);
  }
  return places;
}

std::string shift_of(const Series& series) {
  const ChangePoint& change = *series.change;
  if (!series.is_time) return fmt::format("{:g} to {:g}", change.before, change.after);
  const std::string share =
      change.before > 0 ? fmt::format(", {:+.0f} %", 100 * change.shift / change.before) : "";
  return fmt::format("{:.3f} to {:.3f} ms ({:+.3f} ms{})", change.before, change.after,
                     change.shift, share);
}

std::string place_of(const Trend& trend, const Series& series) {
  return between(run_before(trend, series), run_after(trend, series));
}

std::string between(const RunEntry& before, const RunEntry& after) {
  return fmt::format("between {} and {}", run_name(before), run_name(after));
}

std::string cause_of(const Trend& trend, const Series& series) {
  const RunEntry& before = run_before(trend, series);
  const RunEntry& after = run_after(trend, series);
  std::string text;
  const auto add = [&](const char* what, const std::string& a, const std::string& b) {
    const auto or_none = [](const std::string& one) { return one.empty() ? "none" : one.c_str(); };
    if (a != b)
      text += fmt::format("{}{} {} to {}", text.empty() ? "" : ", ", what, or_none(a), or_none(b));
  };
  add("firmware", before.firmware, after.firmware);
  add("vectors", before.vectors, after.vectors);
  add("tool", before.tool, after.tool);
  add("protocols", before.protocols, after.protocols);
  if (before.cases != after.cases)
    add("results", std::to_string(before.counts.total()), std::to_string(after.counts.total()));
  return text;
}

std::string tested_text(const Trend& trend) {
  return fmt::format("{} Tested: {} totals, and {} of {} groups of cases.", describe_change_test(),
                     trend.tested_totals, trend.tested_topics, trend.topics.size());
}

std::vector<Version> versions_of(const Trend& trend) {
  std::vector<Version> versions;
  for (std::size_t i = 0; i < trend.runs.size(); ++i) {
    const RunEntry& run = trend.runs[i];
    auto one = std::ranges::find(versions, run.firmware, &Version::firmware);
    if (one == versions.end())
      one = versions.insert(versions.end(), {run.firmware, 0, run.started, "", {}, {}});
    ++one->runs;
    one->last = run.started;
    if (trend.replies[i]) one->medians.push_back(trend.replies[i]->median);
    one->red.push_back(static_cast<double>(run.red));
  }
  return versions;
}

}  // namespace fieldproof::history
