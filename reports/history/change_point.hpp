// Where a series of runs shifted: for each series the one place that parts it best, and whether
// that is more than chance.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace fieldproof::history {

struct ChangePoint {
  std::size_t at = 0;             // the first number after the change
  double before = 0, after = 0;   // medians
  double shift = 0;               // Hodges-Lehmann
  double p = 1, corrected_p = 1;  // for the place having been chosen; for all series, too
};

/// What counts, besides chance: a shift of at least `least`, and of `least_share` of the median
/// before.
struct Relevance {
  double least = 0, least_share = 0;
};

/// One for each series, nothing where there is none. With `tested`, how many series were long
/// enough and not all the same.
std::vector<std::optional<ChangePoint>> change_points(
    const std::vector<std::vector<double>>& series, const Relevance& relevance,
    std::size_t& tested);

/// Numbers on either side, and in all: shorter series are not tested.
inline constexpr std::size_t least_side = 4;

/// The test in words.
std::string describe_change_test();

}  // namespace fieldproof::history
