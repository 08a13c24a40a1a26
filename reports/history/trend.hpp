// How a device went over its runs: reply times, counts, where they changed, and what is flaky.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "reports/history/change_point.hpp"
#include "reports/history/flaky.hpp"
#include "reports/history/history.hpp"

namespace fieldproof::history {

struct Series {
  std::string name;               // "reply times", "xgt_cnet/rss", "red", "judged"
  bool is_time = true;            // in ms; else results
  std::vector<std::size_t> runs;  // into Trend::runs
  std::vector<double> values;     // one each
  std::optional<ChangePoint> change;
};

/// Neighbours in a history too short for the test over runs, compared reply by reply.
struct Step {
  std::size_t before = 0, after = 0;  // into Trend::runs
  std::string outcome;                // "4 newly failing, 2 slower"
};

struct Trend {
  std::string device;
  std::vector<RunEntry> runs;  // that came to their end, the oldest first
  std::vector<std::optional<results::ResponseFigures>> replies;  // of each run, all together
  std::vector<Series> totals;                                    // reply times, red, judged
  std::vector<Series> topics;                                    // reply times
  std::size_t tested_totals = 0, tested_topics = 0;
  std::vector<FlakyCase> flaky;
  std::vector<Step> steps;    // in which something changed; only of fewer than 2 * least_side runs
  std::size_t older = 0;      // runs before these, left out
  std::size_t not_ended = 0;  // killed or interrupted, left out
  std::size_t devices = 1;    // in the history
};

/// `last`: so many runs at most; 0: all. `device` is empty for that of the last run, else its name
/// or a part that only one has.
Result<Trend> trend_of(History& history, const std::string& device, std::size_t last);

/// Totals and topics that changed, in this order.
std::vector<const Series*> changed(const Trend& trend);
/// The same, those at one place together: the place with the first of them first.
std::vector<std::vector<const Series*>> changed_by_place(const Trend& trend);
/// "between run 12 (V1.40, 2026-05-01) and run 13 (V1.41, 2026-05-02)".
std::string between(const RunEntry& before, const RunEntry& after);
/// "2.104 to 3.208 ms (+1.104 ms, +52 %)", or "0 to 12".
std::string shift_of(const Series& series);
/// Between which runs.
std::string place_of(const Trend& trend, const Series& series);
/// What else is new there: "firmware V1.40 to V1.41, vectors a1b2 to c3d4"; empty: nothing.
std::string cause_of(const Trend& trend, const Series& series);
/// The test, and how many series it was used on.
std::string tested_text(const Trend& trend);

/// Runs of one firmware together.
struct Version {
  std::string firmware;
  std::size_t runs = 0;
  std::string first, last;           // started
  std::vector<double> medians, red;  // one a run
};
/// In the order of their first run.
std::vector<Version> versions_of(const Trend& trend);

}  // namespace fieldproof::history
