#include "harness/vectors/citations.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "src/base/spelling.hpp"

namespace fieldproof::vectors {

namespace {

/// Empty, or what is wrong.
std::string resolve(Source& source, const StatementsById& known) {
  if (source.statements.empty() || !source.quote.empty()) return {};  // words of its own
  const auto found = known.find(source.statements.front());
  if (found == known.end()) return no_statement(source.statements.front(), known);
  source.manual = found->second->manual;
  source.section = found->second->section;
  source.quote = found->second->quote;
  return {};
}

}  // namespace

StatementsById statements_by_id(const VectorSet& set) {
  StatementsById known;
  for (const Statement& one : set.statements) known.emplace(one.id, &one);
  return known;
}

std::string no_statement(std::string_view id, const StatementsById& known) {
  std::vector<std::string_view> ids;
  for (const auto& [one, statement] : known) ids.push_back(one);
  return fmt::format("no statement '{}' in statements/{}", id, suggestion(id, ids));
}

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
  const StatementsById known = statements_by_id(set);
  for (std::vector<Case>* cases : {&set.cases, &set.tables})
    for (Case& one : *cases) {
      const auto report = [&](const std::string& problem, const std::string& where) {
        if (!problem.empty())
          set.problems.push_back(fmt::format("{}: {}: {}{}", one.file, one.id, where, problem));
      };
      report(resolve(one.source, known), "");
      for (std::size_t i = 0; i < one.steps.size(); ++i)
        report(resolve(one.steps[i].source, known), fmt::format("steps[{}]: ", i));
    }
}

}  // namespace fieldproof::vectors
