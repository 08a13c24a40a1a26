#include "suites/mutants/coverage.hpp"

#include <algorithm>
#include <numeric>

#include "suites/mutants/shared_memory.hpp"

namespace fieldproof::mutants {

namespace {

constexpr unsigned char first_time = 1, second_time = 2, was_red = 4;

/// Every trial twice: what it comes by the first time alone is set up once.
int run_twice(const Load& load, const std::vector<Trial>& trials, std::size_t row,
              unsigned char* all, Steps& steps) {
  std::vector<unsigned char> reached(row);
  become(0, reached.data());
  const Result<MutatedDevices> devices = load();
  if (!devices) return -1;
  for (const unsigned char turn : {first_time, second_time})
    for (std::size_t i = 0; i < trials.size(); ++i) {
      steps.next(static_cast<int>(i));
      std::ranges::fill(reached, 0);
      if (trials[i].red(*devices)) all[i * row] |= was_red;
      for (std::size_t m = 1; m < row; ++m)
        if (reached[m]) all[i * row + m] |= turn;
    }
  return static_cast<int>(trials.size());
}

}  // namespace

Result<Coverage> Coverage::measure(const Load& load, const std::vector<Trial>& trials,
                                   const std::vector<Mutant>& mutants, double seconds) {
  Coverage coverage(mutants.size());
  const std::size_t row = coverage.row_;
  SharedMemory<unsigned char> all(trials.size() * row);
  const Ended ended = in_children(1, {1, seconds, 0}, [&](std::size_t, Steps& steps) {
    return run_twice(load, trials, row, all.data(), steps);
  })[0];
  if (ended.value < 0) return fail("the mutated devices cannot be loaded; build them");
  if (ended.how != Ended::How::returned)
    return fail("the healthy device does not survive " +
                trials[static_cast<std::size_t>(ended.value)].name);
  for (const Mutant& mutant : mutants)
    coverage.once_[static_cast<std::size_t>(mutant.id)] = mutant.once;
  coverage.reached_.resize(trials.size() * row);
  std::vector<std::size_t> counts(trials.size());
  for (std::size_t i = 0; i < trials.size(); ++i) {
    if (all[i * row] & was_red) {
      ++coverage.red_;
      continue;
    }
    coverage.order_.push_back(i);
    for (std::size_t m = 1; m < row; ++m) {
      const unsigned char seen = all[i * row + m];
      if (seen == first_time) coverage.once_[m] = true;
      if (!seen) continue;
      coverage.reached_[i * row + m] = true;
      ++counts[i];
    }
  }
  std::ranges::stable_sort(coverage.order_, {}, [&](std::size_t i) { return counts[i]; });
  return coverage;
}

std::vector<std::size_t> Coverage::showing(const Mutant& mutant) const {
  std::vector<std::size_t> trials;
  const bool once = once_[static_cast<std::size_t>(mutant.id)];
  for (const std::size_t i : order_)
    if (once || reaches(i, mutant.id)) trials.push_back(i);
  return trials;
}

}  // namespace fieldproof::mutants
