#include <fmt/format.h>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "harness/bench/files/profile.hpp"
#include "harness/cli/commands.hpp"
#include "harness/paths.hpp"
#include "harness/run/run_report.hpp"
#include "harness/run/tool_vectors.hpp"
#include "harness/vectors/decisions.hpp"
#include "harness/vectors/errata.hpp"
#include "harness/vectors/lint/citation_rules.hpp"
#include "harness/vectors/lint/lint.hpp"
#include "harness/vectors/loader.hpp"
#include "reports/results/whole_file.hpp"

namespace fieldproof::cli {

namespace {

namespace fs = std::filesystem;

void add(std::vector<std::string>& all, std::vector<std::string> more) {
  all.insert(all.end(), more.begin(), more.end());
}

/// What stands in a profile and means nothing to protocols and vectors. `whole`: the set is the one
/// profiles are made for.
std::vector<std::string> lint_profile(const bench::Profile& profile, const vectors::VectorSet& set,
                                      bool whole, const harness::Protocols& protocols) {
  std::vector<std::string> problems;
  bool emulated = profile.model.empty();
  for (const std::string& name : profile.protocols) {
    const Result<const harness::Protocol*> protocol = protocols.choose(name, "");
    if (!protocol)
      problems.push_back(protocol.error().message);
    else
      emulated = emulated || (*protocol)->has_model(profile.model);
  }
  if (const Status exist = vectors::check_binding(profile.decisions, set); whole && !exist)
    problems.push_back("decisions: " + exist.error().message);
  if (!emulated && profile.notes.empty())
    problems.push_back(fmt::format(
        "no case is for the model '{}'; write in \"notes\" why, or correct it", profile.model));
  for (const auto& [pattern, reason] : profile.exclude)
    if (whole && std::ranges::none_of(set.cases, [&](const vectors::Case& one) {
          return vectors::matches_filter(one.id, pattern);
        }))
      problems.push_back(fmt::format("excludes '{}', which is no case", pattern));
  return problems;
}

std::vector<std::string> lint_profiles(const fs::path& folder, const vectors::VectorSet& set,
                                       bool whole, const harness::Protocols& protocols) {
  std::vector<std::string> problems;
  for (const std::string& name : bench::profile_names(folder)) {
    const std::string file = name + ".json";
    const Result<bench::Profile> profile = bench::load_profile(name, folder);
    if (!profile) {
      problems.push_back(profile.error().message);
      continue;
    }
    if (profile->name != name)
      problems.push_back(fmt::format("{}: its name is '{}'", file, profile->name));
    for (const std::string& problem : lint_profile(*profile, set, whole, protocols))
      problems.push_back(fmt::format("{}: {}", file, problem));
  }
  std::ranges::sort(problems);
  return problems;
}

std::string read_lock(const fs::path& folder) {
  const Result<std::string> lock = results::read_whole_file(folder / "quotes.lock");
  return lock ? *lock : "";
}

int tell_problems(const vectors::VectorSet& set, const std::vector<std::string>& problems) {
  for (const std::string& problem : problems) run::tell(fmt::format("{}\n", problem));
  run::tell(fmt::format("{} cases, {} tables, {} statements, {} errata: {} problems\n",
                        set.cases.size(), set.tables.size(), set.statements.size(),
                        set.errata.size(), problems.size()));
  return problems.empty() ? run::exit_code::ok : run::exit_code::usage;
}

}  // namespace

int lint_command(const LintOptions& options, const harness::Protocols& protocols) {
  const harness::DataPaths data = harness::find_data();
  const fs::path folder = run::vectors_path(options.vectors);
  vectors::VectorSet set = vectors::load_vectors(folder, {protocols});
  // What was not read would be missed everywhere else: that says nothing new.
  if (!set.problems.empty()) return tell_problems(set, set.problems);
  vectors::load_wires(folder, set);
  run::add_decisions(folder, set);
  std::vector<std::string> problems = set.problems;
  add(problems, vectors::lint_wires(set, protocols));
  add(problems, vectors::lint_links(set, protocols));
  add(problems, vectors::lint_duplicates(set, protocols));
  add(problems, vectors::lint_statements(set));
  add(problems, vectors::lint_errata(set));
  add(problems, vectors::lint_decisions(set));
  add(problems, vectors::lint_citation_rules(folder, set));
  add(problems, vectors::lint_readings(set));
  add(problems, vectors::lint_tables(set, protocols));
  add(problems, lint_profiles(data.profiles, set, options.vectors.empty(), protocols));
  const std::vector<std::string> quotes = options.manuals.empty()
                                              ? vectors::lint_lock(set, read_lock(folder))
                                              : vectors::lint_quotes(set, options.manuals);
  add(problems, quotes);
  if (options.lock && options.manuals.empty())
    return run::complain("--lock needs --manuals DIR: only verified quotes are locked",
                         run::exit_code::usage);
  if (options.lock && quotes.empty())
    std::ofstream(folder / "quotes.lock") << vectors::quotes_lock(set);
  return tell_problems(set, problems);
}

}  // namespace fieldproof::cli
