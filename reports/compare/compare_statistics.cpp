#include "reports/compare/compare_statistics.hpp"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/special_functions/binomial.hpp>
#include <cmath>
#include <numeric>

namespace fieldproof::compare {
namespace {

/// Up to here the exact distribution costs next to nothing; beyond, the normal one is as good.
constexpr std::size_t exact_smaller = 10, exact_all = 40;
constexpr std::size_t most_pairs = 250'000;

/// Ranks of both samples together, doubled so that the middle ranks of ties are whole numbers;
/// `before` first.
struct Ranks {
  std::vector<std::size_t> doubled;
  double tie_sum = 0;  // of t^3 - t over groups of equal values
};

Ranks rank(const std::vector<double>& before, const std::vector<double>& after) {
  std::vector<double> all = before;
  all.insert(all.end(), after.begin(), after.end());
  std::vector<std::size_t> order(all.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t i) { return all[i]; });
  Ranks ranks{std::vector<std::size_t>(all.size()), 0};
  for (std::size_t first = 0, last = 0; first < order.size(); first = last) {
    while (last < order.size() && all[order[last]] == all[order[first]]) ++last;
    for (std::size_t i = first; i < last; ++i) ranks.doubled[order[i]] = first + last + 1;
    const auto ties = static_cast<double>(last - first);
    ranks.tie_sum += ties * ties * ties - ties;
  }
  return ranks;
}

/// Among all ways to choose `count` of the ranks, the share whose sum lies as far from the middle
/// as `sum`, or farther.
double exact_p(const std::vector<std::size_t>& ranks, std::size_t count, std::size_t sum) {
  const std::size_t total = std::accumulate(ranks.begin(), ranks.end(), std::size_t{0});
  std::vector<std::vector<double>> ways(count + 1, std::vector<double>(total + 1, 0.0));
  ways[0][0] = 1;
  std::size_t reached = 0;
  for (std::size_t i = 0; i < ranks.size(); ++i) {
    reached += ranks[i];
    for (std::size_t chosen = std::min(count, i + 1); chosen >= 1; --chosen)
      for (std::size_t s = reached; s >= ranks[i]; --s)
        ways[chosen][s] += ways[chosen - 1][s - ranks[i]];
  }
  const double middle =
      static_cast<double>(total) * static_cast<double>(count) / static_cast<double>(ranks.size());
  const double distance = std::abs(static_cast<double>(sum) - middle) - 1e-9;
  double all = 0, far = 0;
  for (std::size_t s = 0; s <= total; ++s) {
    all += ways[count][s];
    if (std::abs(static_cast<double>(s) - middle) >= distance) far += ways[count][s];
  }
  return far / all;
}

/// With the variance that ties leave, and the correction for whole ranks.
double normal_p(const Ranks& ranks, double n1, double n2, double doubled_sum) {
  const double n = n1 + n2;
  const double variance = n1 * n2 / 12 * (n + 1 - ranks.tie_sum / (n * (n - 1)));
  if (variance <= 0) return 1;
  const double distance = std::max(0.0, std::abs(doubled_sum / 2 - n1 * (n + 1) / 2) - 0.5);
  return std::min(1.0, 2 * boost::math::cdf(boost::math::complement(
                               boost::math::normal(), distance / std::sqrt(variance))));
}

double hodges_lehmann(const std::vector<double>& before, const std::vector<double>& after) {
  if (before.size() > most_pairs / after.size()) return median(after) - median(before);
  std::vector<double> differences;
  differences.reserve(before.size() * after.size());
  for (const double a : before)
    for (const double b : after) differences.push_back(b - a);
  return median(std::move(differences));
}

}  // namespace

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  if (values.size() % 2 == 1) return *middle;
  return (*std::max_element(values.begin(), middle) + *middle) / 2;
}

RankTest mann_whitney(const std::vector<double>& before, const std::vector<double>& after) {
  if (before.empty() || after.empty()) return {};
  const Ranks ranks = rank(before, after);
  const bool before_is_smaller = before.size() <= after.size();
  const auto split = ranks.doubled.begin() + static_cast<std::ptrdiff_t>(before.size());
  const std::size_t sum = before_is_smaller
                              ? std::accumulate(ranks.doubled.begin(), split, std::size_t{0})
                              : std::accumulate(split, ranks.doubled.end(), std::size_t{0});
  const std::size_t smaller = std::min(before.size(), after.size());
  RankTest test;
  test.shift = hodges_lehmann(before, after);
  test.exact = smaller <= exact_smaller && ranks.doubled.size() <= exact_all;
  test.p = test.exact ? exact_p(ranks.doubled, smaller, sum)
                      : normal_p(ranks, static_cast<double>(smaller),
                                 static_cast<double>(ranks.doubled.size() - smaller),
                                 static_cast<double>(sum));
  return test;
}

std::vector<double> holm(const std::vector<double>& p) {
  std::vector<std::size_t> order(p.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t i) { return p[i]; });
  std::vector<double> corrected(p.size());
  double highest = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    highest = std::max(highest, std::min(1.0, p[order[i]] * static_cast<double>(p.size() - i)));
    corrected[order[i]] = highest;
  }
  return corrected;
}

std::size_t samples_needed(std::size_t tests, double alpha) {
  unsigned n = 2;
  while (2 / boost::math::binomial_coefficient<double>(2 * n, n) >
         alpha / static_cast<double>(std::max<std::size_t>(tests, 1)))
    ++n;
  return n;
}

}  // namespace fieldproof::compare
