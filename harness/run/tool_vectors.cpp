#include "harness/run/tool_vectors.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/paths.hpp"
#include "harness/vectors/decisions.hpp"
#include "harness/vectors/filter.hpp"
#include "harness/vectors/lint/lint.hpp"

namespace fieldproof::run {

std::filesystem::path vectors_path(const std::string& option) {
  return option.empty() ? harness::find_data().vectors : std::filesystem::path(option);
}

Result<vectors::VectorSet> load_sound_vectors(const std::string& option,
                                              const harness::Protocols& protocols,
                                              const std::string& filter) {
  vectors::VectorSet set = vectors::load_vectors(vectors_path(option),
                                                 {protocols, filter, harness::find_data().vectors});
  add_decisions(vectors_path(option), set);
  if (set.problems.empty()) set.problems = vectors::contradictions(set, protocols);
  if (set.problems.empty()) return set;
  return fail(fmt::format(
      "{}\n{} in the vectors; nothing was sent. `fieldproof lint` shows them all",
      fmt::join(set.problems, "\n"),
      set.problems.size() == 1 ? "1 problem" : fmt::format("{} problems", set.problems.size())));
}

void add_decisions(const std::filesystem::path& from, vectors::VectorSet& set) {
  constexpr const char* file = "DECISIONS.md";
  const bool folder = std::filesystem::is_directory(from);
  vectors::load_decisions((folder ? from : from.parent_path()) / file, set);
  const std::filesystem::path own = harness::find_data().vectors;
  if (from != own) vectors::load_decisions(own / file, set);
}

Status check_decisions(const bench::Profile& profile, const vectors::VectorSet& set) {
  if (const Status exist = vectors::check_binding(profile.decisions, set); !exist)
    return fail(
        fmt::format("cannot use profile {}: decisions: {}", profile.name, exist.error().message));
  return ok();
}

std::string meant_filter(const std::string& option, const harness::Protocols& protocols,
                         const std::string& filter) {
  const Result<vectors::VectorSet> all = load_sound_vectors(option, protocols);
  return all ? vectors::meant_filter(filter, case_ids(*all)) : std::string();
}

std::vector<std::string> case_ids(const vectors::VectorSet& set) {
  std::vector<std::string> ids;
  for (const vectors::Case& one : set.cases) ids.push_back(one.id);
  return ids;
}

results::ErratumInfo erratum_info(const vectors::Erratum& erratum, std::vector<std::string> met) {
  const auto passages = [](const std::vector<vectors::Passage>& list) {
    std::vector<results::Passage> result;
    for (const vectors::Passage& one : list) result.push_back({one.manual, one.section, one.quote});
    return result;
  };
  return {erratum.id,
          erratum.kind,
          erratum.printed,
          erratum.right,
          erratum.why,
          erratum.effect,
          erratum.doubt,
          passages(erratum.places),
          passages(erratum.proof),
          std::move(met)};
}

}  // namespace fieldproof::run
