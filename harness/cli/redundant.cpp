#include "harness/cli/redundant.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace fieldproof::cli {

namespace {

/// How many of the cases no device of the matrix has met.
std::size_t unknown(const std::set<std::string>& ids, const vectors::FaultMatrix& matrix) {
  std::size_t count = 0;
  for (const std::string& id : ids)
    count += std::ranges::none_of(
        matrix, [&](const vectors::BrokenDevice& device) { return device.killed.contains(id); });
  return count;
}

}  // namespace

std::string redundant_text(const vectors::VectorSet& set, const vectors::FaultMatrix& matrix) {
  std::set<std::string> ids;
  for (const vectors::Case& one : set.cases) ids.insert(one.id);
  std::string text, red_by_none;
  std::size_t faults = 0, groups = 0, surplus = 0, never = 0;
  for (const vectors::BrokenDevice& device : matrix) faults += device.faults.size();
  for (const vectors::Alike& alike : vectors::not_told_apart(matrix, ids)) {
    if (alike.by.empty()) {
      never += alike.cases.size();
      red_by_none += fmt::format("{}: no fault turns these red\n  {}\n", alike.device,
                                 fmt::join(alike.cases, "\n  "));
      continue;
    }
    ++groups;
    surplus += alike.cases.size() - 1;
    text += fmt::format("{}: the same faults turn these red ({})\n  {}\n", alike.device, alike.by,
                        fmt::join(alike.cases, "\n  "));
  }
  return text + red_by_none +
         fmt::format(
             "{} cases, {} faults: {} cases in {} groups are told apart from another by no fault, "
             "{} turn red by none, {} have met no broken device\n",
             ids.size(), faults, surplus + groups, groups, never, unknown(ids, matrix));
}

}  // namespace fieldproof::cli
