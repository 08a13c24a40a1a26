// The order of cases in which a device that is started for its configuration is started the least
// often.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "harness/vectors/case.hpp"

namespace fieldproof::bench {

/// What a case wants of the device before it begins.
struct SetUpOfCase {
  std::string started_with;  // another one is another start; empty: none
  std::string needed;        // of the configuration; what is told, where it is not started for it
  bool fresh = false;        // and a device that nobody has asked yet
};

/// Those of one start behind each other, over the whole run, and among them those of one
/// configuration; else in their order. The declared device comes first, since the opening exchange
/// has started it. A fresh device is there right behind a start.
std::vector<const vectors::Case*> fewest_starts(
    const std::vector<const vectors::Case*>& cases,
    const std::function<SetUpOfCase(const vectors::Case&)>& set_up_of);

}  // namespace fieldproof::bench
