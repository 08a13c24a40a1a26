#include "reports/history/storage/packed_run.hpp"

#include <algorithm>
#include <array>

#include "reports/text/case_text.hpp"

namespace fieldproof::history {

using compare::CaseSummary;
using compare::RunSummary;
using results::ResponseFigures;
using results::Verdict;

namespace {

/// They stand in files: a new one goes to the end.
constexpr std::array<Verdict, 11> verdict_codes = {
    Verdict::pass,    Verdict::marginal,     Verdict::non_strict, Verdict::info,
    Verdict::fail,    Verdict::xfail,        Verdict::xpass,      Verdict::skip,
    Verdict::blocked, Verdict::inconclusive, Verdict::error};

/// A nanosecond is the step of our clocks: nothing is lost.
std::int64_t to_ns(double ms) { return from_ms(ms).count(); }
double from_ns(std::int64_t ns) { return to_ms(Duration(ns)); }

constexpr std::size_t topic_columns = 6;

}  // namespace

std::int64_t code_of(Verdict verdict) {
  return std::ranges::find(verdict_codes, verdict) - verdict_codes.begin();
}

std::optional<Verdict> verdict_of(std::int64_t code) {
  if (code < 0 || code >= std::ssize(verdict_codes)) return std::nullopt;
  return verdict_codes[static_cast<std::size_t>(code)];
}

CaseLists lists_of(const RunSummary& run) {
  CaseLists lists;
  for (const auto& [name, one] : run.cases) {
    lists.revs.push_back(one.rev);
    lists.verdicts.push_back(code_of(one.verdict));
    lists.repetitions.push_back(static_cast<std::int64_t>(one.repetitions));
    lists.with_verdict.push_back(static_cast<std::int64_t>(one.with_verdict));
    lists.floors.push_back(to_ns(one.timing_floor_ms));
    lists.replies.push_back(std::ssize(one.response_ms));
    std::ranges::transform(one.response_ms, std::back_inserter(lists.times), to_ns);
  }
  return lists;
}

std::optional<std::map<std::string, CaseSummary>> cases_of(
    const CaseLists& lists, const std::vector<std::string>& names,
    const std::vector<std::string>& messages) {
  for (const Numbers* list : {&lists.revs, &lists.verdicts, &lists.repetitions, &lists.with_verdict,
                              &lists.floors, &lists.replies})
    if (list->size() != names.size()) return std::nullopt;
  if (messages.size() != names.size()) return std::nullopt;
  std::map<std::string, CaseSummary> cases;
  auto time = lists.times.begin();
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::optional<Verdict> verdict = verdict_of(lists.verdicts[i]);
    if (!verdict || lists.replies[i] < 0 || lists.replies[i] > lists.times.end() - time)
      return std::nullopt;
    CaseSummary& one = cases.emplace_hint(cases.end(), names[i], CaseSummary{})->second;
    one.verdict = *verdict;
    one.message = messages[i];
    one.rev = static_cast<int>(lists.revs[i]);
    one.repetitions = static_cast<std::size_t>(lists.repetitions[i]);
    one.with_verdict = static_cast<std::size_t>(lists.with_verdict[i]);
    one.timing_floor_ms = from_ns(lists.floors[i]);
    for (const auto last = time + lists.replies[i]; time != last; ++time)
      one.response_ms.push_back(from_ns(*time));
  }
  return cases;
}

Topics topics_of(const RunSummary& run) {
  std::map<std::string, results::ResponseTimes> times;
  for (const auto& [name, one] : run.cases) {
    const bool holds = results::is_judged(one.verdict) && one.verdict != Verdict::xfail &&
                       !results::gates(one.verdict, run.gate);
    if (!holds || one.response_ms.empty()) continue;
    for (const std::string& topic : {std::string(), text::group_of(name)})
      for (const double ms : one.response_ms) times[topic].add(ms);
  }
  Topics topics;
  for (const auto& [topic, all] : times) topics.emplace(topic, results::figures_of(all));
  return topics;
}

Numbers to_numbers(const Topics& topics, const Numbers& names) {
  Numbers numbers = to_steps(names);
  for (const auto& [name, figures] : topics)
    numbers.push_back(static_cast<std::int64_t>(figures.count));
  for (const auto column : {&ResponseFigures::least, &ResponseFigures::median,
                            &ResponseFigures::p99, &ResponseFigures::greatest})
    for (const auto& [name, figures] : topics) numbers.push_back(to_ns(figures.*column));
  return numbers;
}

std::optional<std::vector<TopicFigures>> topics_from(const Numbers& numbers) {
  if (numbers.size() % topic_columns != 0) return std::nullopt;
  std::vector<TopicFigures> topics(numbers.size() / topic_columns);
  auto next = numbers.begin();
  std::int64_t name = 0;
  for (TopicFigures& one : topics) one.name = name += *next++;
  for (TopicFigures& one : topics) one.figures.count = static_cast<std::uint64_t>(*next++);
  for (const auto column : {&ResponseFigures::least, &ResponseFigures::median,
                            &ResponseFigures::p99, &ResponseFigures::greatest})
    for (TopicFigures& one : topics) one.figures.*column = from_ns(*next++);
  return topics;
}

}  // namespace fieldproof::history
