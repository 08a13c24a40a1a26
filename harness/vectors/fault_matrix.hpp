// Which case turns red by which fault of our broken devices: vectors/faults.json, which
// `fieldproof_faults` writes from runs (suites/faults).
#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "src/base/result.hpp"

namespace fieldproof::vectors {

/// One device that can be broken in many ways, one at a time.
struct BrokenDevice {
  std::string name;                 // "xgt-cnet", "xgt-cnet client"
  std::vector<std::string> faults;  // names
  /// By id of the case: the positions in `faults` of those that turn it red. Cases that no device
  /// without a fault passes are not listed.
  std::map<std::string, std::set<std::size_t>> killed;
};

using FaultMatrix = std::vector<BrokenDevice>;

/// The file: each case on a line of its own, its faults as "0-3 17".
std::string to_text(const FaultMatrix& matrix);
/// Errors name what is not understood.
Result<FaultMatrix> parse_fault_matrix(const std::string& text);
/// Empty where there is no such file.
Result<FaultMatrix> load_fault_matrix(const std::filesystem::path& folder);

/// "0-3 17".
std::string ranges(const std::set<std::size_t>& numbers);

/// The cases that at least one fault turns red.
std::set<std::string, std::less<>> killed_by_any(const FaultMatrix& matrix);

/// Cases of one device that no fault tells apart, two at least; those that no fault turns red are
/// one of the groups, with an empty `by`.
struct Alike {
  std::string device, by;
  std::vector<std::string> cases;  // ids
};
/// `among`: the cases that there are.
std::vector<Alike> not_told_apart(const FaultMatrix& matrix, const std::set<std::string>& among);

}  // namespace fieldproof::vectors
