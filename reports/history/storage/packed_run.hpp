// A run as the lists of numbers that a history keeps of it.
#pragma once

#include <string>
#include <vector>

#include "reports/compare/compare.hpp"
#include "reports/history/storage/packed_list.hpp"
#include "reports/results/response_times.hpp"

namespace fieldproof::history {

/// One number a case, in the order of their names, but for `times`.
struct CaseLists {
  Numbers revs, verdicts, repetitions, with_verdict;
  Numbers floors;   // what the link cannot tell apart, in ns
  Numbers replies;  // how many of `times` are of the case
  Numbers times;    // of all replies, in ns
};

/// What stands for a verdict in a list.
std::int64_t code_of(results::Verdict verdict);
/// Nothing for a number that no verdict has.
std::optional<results::Verdict> verdict_of(std::int64_t code);

CaseLists lists_of(const compare::RunSummary& run);
/// The cases of these names and messages back; nothing where the lists do not fit to each other.
std::optional<std::map<std::string, compare::CaseSummary>> cases_of(
    const CaseLists& lists, const std::vector<std::string>& names,
    const std::vector<std::string>& messages);

/// Reply times by group of cases ("xgt_cnet/rss"), of those that hold: a wrong answer takes its own
/// time.
using Topics = std::map<std::string, results::ResponseFigures>;
/// With those of all replies under the empty name.
Topics topics_of(const compare::RunSummary& run);
/// A column after the other; `names`: the number that stands for each.
Numbers to_numbers(const Topics& topics, const Numbers& names);
struct TopicFigures {
  std::int64_t name = 0;
  results::ResponseFigures figures;
};
std::optional<std::vector<TopicFigures>> topics_from(const Numbers& numbers);

}  // namespace fieldproof::history
