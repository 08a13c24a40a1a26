#include "reports/history/change_point.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "reports/compare/compare.hpp"
#include "reports/compare/compare_statistics.hpp"

namespace fieldproof::history {

namespace {

std::vector<double> ranks_of(const std::vector<double>& series) {
  std::vector<std::size_t> order(series.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t i) { return series[i]; });
  std::vector<double> ranks(series.size());
  for (std::size_t first = 0, last = 0; first < order.size(); first = last) {
    while (last < order.size() && series[order[last]] == series[order[first]]) ++last;
    for (std::size_t i = first; i < last; ++i)
      ranks[order[i]] = static_cast<double>(first + last + 1) / 2;
  }
  return ranks;
}

/// Where the sum of ranks before lies farthest from what chance expects, in its own deviations.
std::size_t best_place(const std::vector<double>& series) {
  const std::vector<double> ranks = ranks_of(series);
  const auto n = static_cast<double>(series.size());
  std::size_t best = least_side;
  double farthest = -1, sum = 0;
  for (std::size_t i = 1; i + least_side <= series.size(); ++i) {
    sum += ranks[i - 1];
    if (i < least_side) continue;
    const auto before = static_cast<double>(i);
    const double far = std::abs(sum - before * (n + 1) / 2) / std::sqrt(before * (n - before));
    if (far > farthest * (1 + 1e-12)) farthest = far, best = i;
  }
  return best;
}

ChangePoint best_change(const std::vector<double>& series) {
  ChangePoint change;
  change.at = best_place(series);
  const auto middle = series.begin() + static_cast<std::ptrdiff_t>(change.at);
  const std::vector<double> before(series.begin(), middle), after(middle, series.end());
  const compare::RankTest test = compare::mann_whitney(before, after);
  const std::size_t places = series.size() - 2 * least_side + 1;
  change.p = std::min(1.0, test.p * static_cast<double>(places));
  change.before = compare::median(before);
  change.after = compare::median(after);
  change.shift = test.shift;
  return change;
}

bool can_be_tested(const std::vector<double>& series) {
  return series.size() >= 2 * least_side &&
         std::ranges::adjacent_find(series, std::ranges::not_equal_to()) != series.end();
}

}  // namespace

std::vector<std::optional<ChangePoint>> change_points(
    const std::vector<std::vector<double>>& series, const Relevance& relevance,
    std::size_t& tested) {
  std::vector<std::optional<ChangePoint>> changes;
  std::vector<double> p;
  for (const std::vector<double>& one : series) {
    changes.push_back(can_be_tested(one) ? std::optional(best_change(one)) : std::nullopt);
    if (changes.back()) p.push_back(changes.back()->p);
  }
  tested = p.size();
  auto corrected = compare::holm(p);
  auto next = corrected.begin();
  for (std::optional<ChangePoint>& one : changes) {
    if (!one) continue;
    one->corrected_p = *next++;
    const double least = std::max(relevance.least, relevance.least_share * one->before);
    if (one->corrected_p > compare::TimingTest::alpha || std::abs(one->shift) < least) one.reset();
  }
  return changes;
}

std::string describe_change_test() {
  return fmt::format(
      "Mann-Whitney U, two-sided, on one number a run (the median of its replies, or a count): the "
      "runs before against the runs after the place that parts their ranks best, with at least {} "
      "runs on either side. p is multiplied by the number of such places (Bonferroni), then Holm's "
      "correction over all series that are not constant; a change is named where the corrected p "
      "is at most {}, and the Hodges-Lehmann shift at least {} % of the median before and {} ms, "
      "or "
      "one case.",
      least_side, compare::TimingTest::alpha, compare::TimingTest::least_share * 100,
      compare::TimingTest::least_ms);
}

}  // namespace fieldproof::history
