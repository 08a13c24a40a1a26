#include "harness/vectors/citations.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <unordered_map>

#include "src/base/spelling.hpp"

namespace fieldproof::vectors {

namespace {

using Known = std::unordered_map<std::string_view, const Statement*>;

/// The nearest id that there is.
std::string near(const std::string& id, const VectorSet& set) {
  std::vector<std::string_view> ids;
  for (const Statement& statement : set.statements) ids.push_back(statement.id);
  return suggestion(id, ids);
}

/// Empty, or what is wrong.
std::string resolve(Source& source, const Known& known, const VectorSet& set) {
  if (source.statements.empty() || !source.quote.empty()) return {};  // words of its own
  const std::string& id = source.statements.front();
  const auto found = known.find(id);
  if (found == known.end())
    return fmt::format("no statement '{}' in statements/{}", id, near(id, set));
  source.manual = found->second->manual;
  source.section = found->second->section;
  source.quote = found->second->quote;
  return {};
}

}  // namespace

std::vector<std::string_view> cited_by(const Case& one) {
  std::vector<std::string_view> ids;
  const auto add = [&](const Source& source) {
    for (const std::string& id : source.statements)
      if (std::ranges::find(ids, id) == ids.end()) ids.push_back(id);
  };
  add(one.source);
  for (const Step& step : one.steps) add(step.source);
  return ids;
}

void resolve_citations(VectorSet& set) {
  Known known;
  for (const Statement& statement : set.statements) known.emplace(statement.id, &statement);
  for (std::vector<Case>* cases : {&set.cases, &set.tables})
    for (Case& one : *cases) {
      const auto report = [&](const std::string& problem, const std::string& where) {
        if (!problem.empty())
          set.problems.push_back(fmt::format("{}: {}: {}{}", one.file, one.id, where, problem));
      };
      report(resolve(one.source, known, set), "");
      for (std::size_t i = 0; i < one.steps.size(); ++i)
        report(resolve(one.steps[i].source, known, set), fmt::format("steps[{}]: ", i));
    }
}

}  // namespace fieldproof::vectors
