// Are the reply times of two runs different, or is it chance? For few samples of any distribution.
#pragma once

#include <cstddef>
#include <vector>

namespace fieldproof::compare {

struct RankTest {
  double p = 1;  // two-sided: how likely chance alone parts the samples so far
  double shift =
      0;  // Hodges-Lehmann: by how much `after` lies above `before`, in the unit of the samples
  bool exact = true;  // p from all ways to deal the values out; else by the normal approximation
};

/// Mann-Whitney U. Ties are taken into account. Empty samples give p = 1.
RankTest mann_whitney(const std::vector<double>& before, const std::vector<double>& after);

/// Holm's correction: with each p so raised, the chance of even one false alarm among all tests
/// stays below the limit that they are compared with. Order is kept.
std::vector<double> holm(const std::vector<double>& p);

/// How many samples each run needs so that a clean shift in one of `tests` can fall below `alpha`.
std::size_t samples_needed(std::size_t tests, double alpha);

double median(std::vector<double> values);

}  // namespace fieldproof::compare
