#include <algorithm>
#include <cstdio>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "harness/cli/commands.hpp"
#include "harness/cli/paths.hpp"
#include "harness/vectors/loader.hpp"

namespace fieldproof {

int errata_command(const ErrataOptions& options) {
  const DataPaths data = find_data();
  VectorSet set = load_vectors(options.vectors.empty() ? data.vectors : std::filesystem::path(options.vectors), data.vectors / "schema.json");
  for (const std::string& problem : set.problems) complain(problem, 0);
  if (!set.problems.empty()) return exit_code::usage;
  std::ranges::stable_sort(set.errata, {}, [](const Erratum& e) { return std::pair(e.manual, e.section); });
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const Erratum& e : set.errata) {
    if (options.json)
      all.push_back({{"manual", e.manual}, {"section", e.section}, {"printed", e.printed}, {"correct", e.correct}, {"why", e.why}, {"vector", e.vector_id}});
    else
      fmt::print("{} {}\n  printed: {}\n  correct: {}\n  why:     {}\n  vector:  {}\n\n", e.manual, e.section, e.printed, e.correct, e.why, e.vector_id);
  }
  if (options.json) fmt::print("{}\n", all.dump(2));
  else fmt::print("{} errata\n", set.errata.size());
  return exit_code::ok;
}

}  // namespace fieldproof
