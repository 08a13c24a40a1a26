// Which mutants each trial comes by on the healthy device: it can show no others.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "suites/mutants/children.hpp"
#include "suites/mutants/table.hpp"
#include "suites/mutants/trials.hpp"

namespace fieldproof::mutants {

class Coverage {
 public:
  /// In a child. The error names a trial that the healthy device does not survive.
  static Result<Coverage> measure(const Load& load, const std::vector<Trial>& trials,
                                  const std::vector<Mutant>& mutants, double seconds);

  /// The trials that may show this mutant, those first that show the fewest others. A mutant that
  /// a program comes by once in its life may show anywhere.
  std::vector<std::size_t> showing(const Mutant& mutant) const;
  /// Trials that are red on the healthy device: they show nothing.
  std::size_t red() const { return red_; }

 private:
  Coverage(std::size_t mutants) : row_(mutants + 1), once_(row_) {}
  bool reaches(std::size_t trial, int mutant) const {
    return reached_[trial * row_ + static_cast<std::size_t>(mutant)];
  }

  std::size_t row_;
  std::vector<bool> reached_;  // a row a trial
  std::vector<bool> once_;     // by the number of the mutant
  std::vector<std::size_t> order_;
  std::size_t red_ = 0;
};

}  // namespace fieldproof::mutants
