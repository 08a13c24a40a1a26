#include "reports/compare/compare.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "reports/compare/compare_statistics.hpp"
#include "reports/text/case_text.hpp"

namespace fieldproof::compare {

using results::CaseResult;
using results::Delivery;
using results::Gate;
using results::RunInfo;
using results::RunLog;
using results::Sink;
using results::Verdict;

namespace {

/// The gravest last.
constexpr std::array<Verdict, 11> gravity = {
    Verdict::pass,         Verdict::info,     Verdict::skip,       Verdict::blocked,
    Verdict::inconclusive, Verdict::marginal, Verdict::non_strict, Verdict::xfail,
    Verdict::xpass,        Verdict::fail,     Verdict::error};

std::size_t gravity_of(Verdict verdict) {
  return static_cast<std::size_t>(std::ranges::find(gravity, verdict) - gravity.begin());
}

enum class Standing { holds, waived, unjudged, red };

Standing standing(Verdict verdict, const Gate& gate) {
  if (results::gates(verdict, gate)) return Standing::red;
  switch (verdict) {
    case Verdict::xfail: return Standing::waived;
    case Verdict::skip:
    case Verdict::blocked:
    case Verdict::inconclusive: return Standing::unjudged;
    default: return Standing::holds;
  }
}

/// A message without its times: they differ from run to run, and are no other reason.
std::string reason(const std::string& message) {
  std::string text;
  for (std::size_t at = 0; at < message.size();) {
    const std::size_t end = std::min(message.find_first_not_of("0123456789.", at), message.size());
    if (end > at && message.compare(end, 3, " ms") == 0)
      text += '#';
    else
      text += message.substr(at, std::max<std::size_t>(end - at, 1));
    at = std::max(end, at + 1);
  }
  return text;
}

void note(const CaseResult& result, CaseSummary& summary) {
  if (summary.repetitions == 0 || gravity_of(result.verdict) > gravity_of(summary.verdict)) {
    summary.verdict = result.verdict;
    summary.message = result.message;
    summary.with_verdict = 0;
  }
  ++summary.repetitions;
  if (result.verdict == summary.verdict) ++summary.with_verdict;
  summary.title = result.title;
  summary.manual = result.manual;
  summary.section = result.section;
  summary.rev = result.rev;
  summary.response_ms.insert(summary.response_ms.end(), result.response_ms.begin(),
                             result.response_ms.end());
  summary.timing_floor_ms = std::max(summary.timing_floor_ms, to_ms(result.recording.link_floor));
}

class Summarizer final : public Sink {
 public:
  explicit Summarizer(RunSummary& into) : into_(into) {}

  Status begin(const RunInfo& run) override {
    into_.run = run;
    into_.gate = text::gate_of(run);
    return ok();
  }
  Status add(const Delivery& one) override {
    into_.tally.add(one->verdict);
    note(*one, into_.cases[text::case_name(*one)]);
    return ok();
  }
  Status end(const RunLog&) override { return ok(); }  // known before: it says what was compared

 private:
  RunSummary& into_;
};

std::optional<Change> change_of(const CaseSummary& before, const CaseSummary& after,
                                const Gate& old_gate, const Gate& new_gate) {
  if (before.rev != after.rev && before.rev != 0 && after.rev != 0) return Change::revised;
  const Standing then = standing(before.verdict, old_gate), now = standing(after.verdict, new_gate);
  if (now == Standing::red) {
    if (then != Standing::red) return Change::newly_failing;
    if (before.verdict != after.verdict || reason(before.message) != reason(after.message))
      return Change::other_reason;
    return std::nullopt;
  }
  if (then == Standing::red && now == Standing::holds) return Change::newly_passing;
  if (then == Standing::holds && now == Standing::unjudged) return Change::no_longer_judged;
  if (before.verdict == after.verdict) return std::nullopt;
  const bool both_hold = then == Standing::holds && now == Standing::holds;
  return both_hold && gravity_of(after.verdict) >
                          std::max(gravity_of(before.verdict), gravity_of(Verdict::info))
             ? Change::weaker
             : Change::other_verdict;
}

/// Times of cases that hold in both: a wrong answer takes its own time.
bool has_comparable_times(const CaseSummary& before, const CaseSummary& after, const Gate& old_gate,
                          const Gate& new_gate) {
  return !before.response_ms.empty() && !after.response_ms.empty() &&
         standing(before.verdict, old_gate) == Standing::holds &&
         standing(after.verdict, new_gate) == Standing::holds;
}

struct Candidate {
  TimeShift shift;
  double least_ms = 0;
};

Candidate test_times(const std::string& id, const CaseSummary& before, const CaseSummary& after,
                     TimingTest& timing) {
  const RankTest test = mann_whitney(before.response_ms, after.response_ms);
  Candidate candidate;
  candidate.shift = {id, median(before.response_ms), median(after.response_ms), test.shift, test.p,
                     1,  before.response_ms.size(),  after.response_ms.size()};
  candidate.least_ms =
      std::max({TimingTest::least_ms, TimingTest::least_share * candidate.shift.before_ms,
                before.timing_floor_ms, after.timing_floor_ms});
  ++timing.tested;
  if (test.exact) ++timing.exact;
  return candidate;
}

/// Corrects over all that was tested, then keeps what is both certain and large enough.
std::vector<TimeShift> significant(const std::vector<Candidate>& candidates) {
  std::vector<double> p;
  for (const Candidate& one : candidates) p.push_back(one.shift.p);
  const std::vector<double> corrected = holm(p);
  std::vector<TimeShift> shifts;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (corrected[i] > TimingTest::alpha ||
        std::abs(candidates[i].shift.shift_ms) < candidates[i].least_ms)
      continue;
    shifts.push_back(candidates[i].shift);
    shifts.back().corrected_p = corrected[i];
  }
  std::ranges::stable_sort(shifts, std::ranges::greater(), &TimeShift::shift_ms);
  return shifts;
}

}  // namespace

RunSummary summarize(const ResultFile& file) {
  RunSummary summary;
  Summarizer sink(summary);
  summary.path = file.path;
  summary.end = file.end;
  [[maybe_unused]] Status taken = sink.begin(file.run);
  for (const CaseResult& result : file.results) taken = sink.add(Delivery(result));
  return summary;
}

std::unique_ptr<Sink> summarizer(RunSummary& into) { return std::make_unique<Summarizer>(into); }

std::string to_string(Change change) {
  switch (change) {
    case Change::newly_failing: return "newly failing";
    case Change::weaker: return "weaker";
    case Change::no_longer_judged: return "no longer judged";
    case Change::newly_passing: return "newly passing";
    case Change::other_reason: return "still failing, for another reason";
    case Change::other_verdict: return "other verdict";
    case Change::added: return "added";
    case Change::removed: return "removed";
    case Change::revised: return "revised, not comparable";
  }
  return "";
}

std::string meaning(Change change) {
  switch (change) {
    case Change::newly_failing: return "red now, and not before";
    case Change::weaker: return "lets the gate pass, but less well than before";
    case Change::no_longer_judged: return "held before, and now there is no verdict on it";
    case Change::newly_passing: return "red before, and holds now";
    case Change::other_reason: return "red in both runs, but the failure is another";
    case Change::other_verdict: return "nothing got worse by it";
    case Change::added: return "in the new run alone";
    case Change::removed: return "in the old run alone";
    case Change::revised: return "the vector asserts something else since its rev rose";
  }
  return "";
}

bool got_worse(Change change) { return change <= Change::no_longer_judged; }

std::size_t Comparison::count(Change change) const {
  return static_cast<std::size_t>(std::ranges::count(changes, change, &CaseChange::change));
}

std::size_t Comparison::slower() const {
  return static_cast<std::size_t>(
      std::ranges::count_if(shifts, [](const TimeShift& one) { return one.shift_ms > 0; }));
}

bool Comparison::worse() const {
  return slower() > 0 ||
         std::ranges::any_of(changes, [](const CaseChange& one) { return got_worse(one.change); });
}

Comparison compare(const RunSummary& before, const RunSummary& after) {
  Comparison comparison;
  comparison.before = &before;
  comparison.after = &after;
  std::vector<Candidate> candidates;
  for (const auto& [id, old] : before.cases) {
    const auto found = after.cases.find(id);
    if (found == after.cases.end()) {
      comparison.changes.push_back({id, Change::removed, &old, nullptr});
      continue;
    }
    const CaseSummary& now = found->second;
    const std::optional<Change> change = change_of(old, now, before.gate, after.gate);
    if (change)
      comparison.changes.push_back({id, *change, &old, &now});
    else
      ++comparison.unchanged;
    if (change == Change::revised || !has_comparable_times(old, now, before.gate, after.gate))
      continue;
    if (std::min(old.response_ms.size(), now.response_ms.size()) < TimingTest::least_replies)
      ++comparison.timing.too_few;
    else
      candidates.push_back(test_times(id, old, now, comparison.timing));
  }
  for (const auto& [id, now] : after.cases)
    if (!before.cases.contains(id))
      comparison.changes.push_back({id, Change::added, nullptr, &now});
  std::ranges::stable_sort(comparison.changes, {}, &CaseChange::change);
  comparison.shifts = significant(candidates);
  return comparison;
}

std::vector<MatrixRow> matrix(const std::vector<RunSummary>& runs) {
  std::set<std::string> ids;
  for (const RunSummary& run : runs)
    for (const auto& [id, summary] : run.cases) ids.insert(id);
  std::vector<MatrixRow> rows;
  for (const std::string& id : ids) {
    MatrixRow row{id, {}, false};
    for (const RunSummary& run : runs) {
      const auto found = run.cases.find(id);
      row.cells.push_back(found == run.cases.end() ? nullptr : &found->second);
    }
    const CaseSummary* first = row.cells.front();
    for (std::size_t i = 1; i < runs.size(); ++i) {
      const CaseSummary* one = row.cells[i];
      row.differs |= first && one
                         ? change_of(*first, *one, runs.front().gate, runs[i].gate).has_value()
                         : first != one;
    }
    rows.push_back(std::move(row));
  }
  std::ranges::stable_partition(rows, &MatrixRow::differs);
  return rows;
}

ComparisonSet::ComparisonSet(std::vector<RunSummary> all)
    : runs(std::move(all)), rows(matrix(runs)) {
  for (std::size_t i = 1; i < runs.size(); ++i)
    comparisons.push_back(compare(runs.front(), runs[i]));
}

bool ComparisonSet::worse() const { return std::ranges::any_of(comparisons, &Comparison::worse); }

std::string ComparisonSet::letter(std::size_t run) {
  std::string name(1, static_cast<char>('A' + run % 26));
  return run < 26 ? name : letter(run / 26 - 1) + name;
}

std::string describe(const TimingTest& timing) {
  std::string text = fmt::format(
      "Mann-Whitney U, two-sided, for each case that holds in both runs with at least {} replies "
      "in each: {} cases, {} by the exact distribution, "
      "the others by the normal one. Holm's correction over all of them: significant where the "
      "corrected p is at most {}, so that the chance "
      "of a single false alarm in the whole comparison stays below it; and reported where the "
      "Hodges-Lehmann shift is at least {} % of the old "
      "median, {} ms, and what the link can tell apart.",
      TimingTest::least_replies, timing.tested, timing.exact, TimingTest::alpha,
      TimingTest::least_share * 100, TimingTest::least_ms);
  if (timing.too_few > 0)
    text += fmt::format(
        " Not tested for too few replies: {} cases; `run --repeat {}` gives enough to see a shift "
        "in one among all.",
        timing.too_few, samples_needed(timing.tested + timing.too_few, TimingTest::alpha));
  return text;
}

std::string outcome(const Comparison& comparison) {
  std::string text;
  const auto add_count = [&](std::size_t count, const std::string& what) {
    if (count > 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, what);
  };
  for (Change change : all_changes)
    if (got_worse(change)) add_count(comparison.count(change), to_string(change));
  add_count(comparison.slower(), "slower");
  return text.empty() ? "nothing got worse" : text;
}

}  // namespace fieldproof::compare
