// Mutants against trials: which are killed, and by what.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "suites/mutants/children.hpp"
#include "suites/mutants/coverage.hpp"

namespace fieldproof::mutants {

enum class Fate { unreached, survived, red, crashed, hung };
std::string_view to_string(Fate fate);
inline bool is_killed(Fate fate) { return fate >= Fate::red; }

struct Outcome {
  Fate fate = Fate::unreached;
  std::string stage;    // that killed it: "vectors"
  std::string by;       // the trial
  std::string section;  // that the most special case cites which comes by it
};

struct Stage {
  std::string name;
  std::vector<Trial> trials;
};

struct HuntOptions {
  const MutatedDevices* devices = nullptr;  // healthy until a child becomes another
  Load fresh;                               // the same once more, with what a program sets up once
  std::size_t numbers = 0;                  // how many mutants the devices have: the highest number
  Effort effort;
  std::function<void(std::size_t done, std::size_t of)> progress;
};

/// Mutants that earlier stages have killed are left alone. The error: on the
/// healthy device every trial is red.
Status hunt(const Stage& stage, const std::vector<Mutant>& mutants, const HuntOptions& options,
            std::vector<Outcome>& outcomes);

}  // namespace fieldproof::mutants
