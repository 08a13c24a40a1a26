#include "suites/mutants/coverage.hpp"

#include <algorithm>

namespace fieldproof::mutants {

namespace {

std::string folder_of(const Mutant& mutant) {
  return mutant.file.substr(0, mutant.file.rfind('/'));
}

}  // namespace

Coverage::Coverage(const MutatedDevices& devices, std::size_t numbers,
                   const std::vector<Trial>& trials, const std::vector<Mutant>& mutants)
    : row_(numbers + 1), reached_(trials.size() * row_), once_(row_) {
  for (const Mutant& mutant : mutants) once_[static_cast<std::size_t>(mutant.id)] = mutant.once;
  run_twice(devices, trials);
  std::vector<std::size_t> counts(trials.size());
  for (std::size_t i = 0; i < trials.size(); ++i)
    for (std::size_t m = 1; m < row_; ++m) counts[i] += reached_[i * row_ + m];
  std::ranges::stable_sort(order_, {}, [&](std::size_t i) { return counts[i]; });
  for (const Mutant& mutant : mutants) {
    std::vector<bool>& trials_at_work = at_work_[folder_of(mutant)];
    trials_at_work.resize(trials.size());
    if (is_once(mutant)) continue;
    for (const std::size_t i : order_)
      if (reaches(i, mutant.id)) trials_at_work[i] = true;
  }
}

void Coverage::run_twice(const MutatedDevices& devices, const std::vector<Trial>& trials) {
  static std::vector<unsigned char> reached;  // as long as there are devices
  reached.assign(row_, 0);
  become(0, reached.data());
  for (const bool again : {false, true})
    for (std::size_t i = 0; i < trials.size(); ++i) {
      std::ranges::fill(reached, 0);
      const bool red = trials[i].red(devices);
      note(i, reached, again);
      if (again) continue;
      if (red)
        ++red_;
      else
        order_.push_back(i);
    }
}

/// What a trial comes by the first time alone has been set up once.
void Coverage::note(std::size_t trial, const std::vector<unsigned char>& reached, bool again) {
  for (std::size_t m = 1; m < row_; ++m) {
    if (again && !reached[m] && reached_[trial * row_ + m]) once_[m] = true;
    if (reached[m]) reached_[trial * row_ + m] = true;
  }
}

std::vector<std::size_t> Coverage::showing(const Mutant& mutant) const {
  std::vector<std::size_t> trials;
  const std::vector<bool>& at_work = at_work_.at(folder_of(mutant));
  for (const std::size_t i : order_)
    if (is_once(mutant) ? at_work[i] : reaches(i, mutant.id)) trials.push_back(i);
  return trials;
}

}  // namespace fieldproof::mutants
