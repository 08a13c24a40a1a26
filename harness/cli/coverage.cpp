#include "harness/cli/coverage.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <functional>
#include <map>
#include <set>

#include "harness/vectors/citations.hpp"
#include "reports/html/html_survey.hpp"

namespace fieldproof::cli {

using reports::CoverageVector;

namespace {

using Vectors = std::map<std::string, CoverageVector>;    // by id
using VectorOf = std::map<std::string, CoverageVector*>;  // by id of the case

void add_results(const compare::ResultFile& file, const VectorOf& vector_of) {
  for (const results::CaseResult& result : file.results) {
    const auto found = vector_of.find(result.id);
    if (found == vector_of.end()) continue;  // of a vector that is gone, or said about a waiver
    CoverageVector& vector = *found->second;
    vector.verdicts.add(result.verdict);
    if (!results::is_judged(result.verdict) && vector.why_not.empty())
      vector.why_not = fmt::format("{}: {}", results::to_string(result.verdict), result.message);
  }
}

}  // namespace

reports::Coverage trace(const vectors::VectorSet& set,
                        const std::optional<compare::ResultFile>& results,
                        const vectors::FaultMatrix& faults) {
  Vectors vectors;
  VectorOf vector_of;
  std::map<std::string, std::set<std::string>> citing;  // ids of vectors by statement
  const auto killed = vectors::killed_by_any(faults);
  std::set<std::string_view> proved;  // statements
  for (const std::vector<vectors::Case>* cases : {&set.cases, &set.tables})
    for (const vectors::Case& one : *cases) {
      CoverageVector& vector = vectors
                                   .try_emplace(one.vector_id, CoverageVector{one.vector_id,
                                                                              one.title,
                                                                              cases == &set.tables,
                                                                              0,
                                                                              {},
                                                                              {},
                                                                              one.level == "info"})
                                   .first->second;
      ++vector.cases;
      vector_of[one.id] = &vector;
      for (const std::string_view statement : vectors::cited_by(one)) {
        citing[std::string(statement)].insert(one.vector_id);
        if (killed.contains(one.id)) proved.insert(statement);
      }
    }
  if (results) add_results(*results, vector_of);

  reports::Coverage coverage;
  coverage.vectors_hash = set.hash;
  coverage.with_faults = !faults.empty();
  if (results) coverage.results = results->path;
  if (results) coverage.endpoint = results->run.endpoint;
  for (const vectors::Manual& manual : set.manuals) {
    reports::CoverageManual& traced =
        coverage.manuals.emplace_back(reports::CoverageManual{manual.id, manual.title, {}, {}});
    if (const auto titles = set.sections.find(manual.id); titles != set.sections.end())
      traced.sections = titles->second;
    for (const vectors::Statement& one : set.statements) {
      if (one.manual != manual.id) continue;
      reports::CoverageStatement& statement =
          traced.statements.emplace_back(reports::CoverageStatement{
              one.id, one.section, one.quote, one.reason, {}, proved.contains(one.id)});
      for (const std::string& id : citing[one.id]) statement.vectors.push_back(vectors.at(id));
    }
    std::ranges::stable_sort(traced.statements, std::less<>{},
                             [&](const reports::CoverageStatement& one) {
                               return html::SectionName{manual.id, one.section};
                             });
  }
  return coverage;
}

}  // namespace fieldproof::cli
