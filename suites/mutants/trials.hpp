// What can turn red on a mutated device: a case, or an exploration.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "harness/vectors/case.hpp"
#include "suites/mutants/mutated_devices.hpp"

namespace fieldproof::mutants {

struct Trial {
  std::string name;      // id of the case; "explore modbus-rtu"
  std::string protocol;  // "modbus-rtu"
  std::string section;   // of the manual that the case cites: "xgb-cnet-en-1.6, 7.1.5"
  std::function<bool(const MutatedDevices&)> red;
};

/// The cases outlive their trials.
std::vector<Trial> trials_of(const std::vector<vectors::Case>& cases);

/// An exploration of so many requests a protocol that can be explored.
std::vector<Trial> explorations(const std::vector<vectors::Case>& cases, std::uint64_t requests);

}  // namespace fieldproof::mutants
