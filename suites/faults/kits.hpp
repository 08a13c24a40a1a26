// All broken devices of this project in one table: what can be wrong with each, and a case against
// one of them, in process.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "harness/vectors/case.hpp"
#include "reports/results/case_result.hpp"

namespace fieldproof::faults {

struct KnownFault {
  std::string name, caught_by;  // the id of the case that must turn red
};

struct Kit {
  std::string name;    // "xgt-cnet", "xgt-cnet client"
  std::string folder;  // of its cases: "xgt_cnet"
  std::vector<KnownFault> faults;
  /// Cases of the folder that are about this device.
  std::function<bool(const vectors::Case&)> concerns;
  /// The case against a new device with the fault of this position; without: against a good one.
  std::function<results::CaseResult(std::optional<std::size_t> fault, const vectors::Case&)> run;
};

std::vector<Kit> kits();

/// Which of its faults `explore` finds with so many requests each, on a device of that fault.
std::vector<bool> found_by_exploring(const Kit& kit, const std::vector<vectors::Case>& cases,
                                     std::uint64_t requests);

}  // namespace fieldproof::faults
