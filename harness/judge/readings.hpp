// Where a manual allows two readings, one name ties the vectors together: a device must keep to its
// choice.
#pragma once

#include <map>
#include <string>
#include <utility>

#include "reports/results/case_result.hpp"

namespace fieldproof::judging {

class Readings {
 public:
  /// Notes the alternatives that a result took. A device that mixes them is NON-STRICT.
  void note(results::CaseResult& result);

 private:
  std::map<std::string, std::pair<std::string, std::string>>
      first_;  // name: first choice and the case that made it
};

}  // namespace fieldproof::judging
