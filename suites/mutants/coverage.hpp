// Which mutants each trial comes by on the healthy device: it can show no others.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "suites/mutants/table.hpp"
#include "suites/mutants/trials.hpp"

namespace fieldproof::mutants {

class Coverage {
 public:
  /// Runs every trial twice on healthy devices. `numbers`: how many mutants they have, wanted or
  /// not.
  Coverage(const MutatedDevices& devices, std::size_t numbers, const std::vector<Trial>& trials,
           const std::vector<Mutant>& mutants);

  /// The trials that may show this mutant, those first that show the fewest others. What a program
  /// comes by once in its life may show wherever something of the same folder is at work.
  std::vector<std::size_t> showing(const Mutant& mutant) const;
  /// A program comes by it once in its life: it is there before any trial.
  bool is_once(const Mutant& mutant) const { return once_[static_cast<std::size_t>(mutant.id)]; }
  /// Trials that are red on the healthy device: they show nothing.
  std::size_t red() const { return red_; }

 private:
  void run_twice(const MutatedDevices& devices, const std::vector<Trial>& trials);
  void note(std::size_t trial, const std::vector<unsigned char>& reached, bool again);
  bool reaches(std::size_t trial, int mutant) const {
    return reached_[trial * row_ + static_cast<std::size_t>(mutant)];
  }

  std::size_t row_;
  std::vector<bool> reached_;  // a row a trial
  std::vector<bool> once_;     // by the number of the mutant
  std::vector<std::size_t> order_;
  std::map<std::string, std::vector<bool>> at_work_;  // by folder: which trials
  std::size_t red_ = 0;
};

}  // namespace fieldproof::mutants
