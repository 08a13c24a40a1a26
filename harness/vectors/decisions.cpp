#include "harness/vectors/decisions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "reports/results/whole_file.hpp"
#include "src/base/spelling.hpp"

namespace fieldproof::vectors {

namespace {

constexpr std::string_view heading = "### ";

bool is_id(std::string_view id) {
  return id.find('/') != id.npos &&
         id.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_/-") == id.npos;
}

const Decision* find(const std::vector<Decision>& decisions, std::string_view id) {
  const auto found = std::ranges::find(decisions, id, &Decision::id);
  return found == decisions.end() ? nullptr : &*found;
}

std::string unknown(std::string_view id, const VectorSet& set) {
  std::vector<std::string_view> known;
  for (const Decision& decision : set.decisions) known.push_back(decision.id);
  return fmt::format("no decision '{}' in DECISIONS.md{}", id, suggestion(id, known));
}

void lint_entries(const VectorSet& set, std::vector<std::string>& problems) {
  for (const auto& [id, sentence] : set.decisions) {
    if (!is_id(id))
      problems.push_back(fmt::format(
          "DECISIONS.md: '{}' is no id; write it as protocol/what-is-decided, in small letters",
          id));
    if (!sentence.ends_with('.'))
      problems.push_back(
          fmt::format("DECISIONS.md: {} does not begin with a sentence on a line of "
                      "its own; reports print that line",
                      id));
  }
}

void lint_case(const Case& one, const VectorSet& set, std::vector<std::string>& problems) {
  if (one.basis == "decision" && one.decisions.empty())
    problems.push_back(
        fmt::format("{}: {}: its basis is a decision, but it cites none; add \"decision\": "
                    "[\"ID\"] with an id of DECISIONS.md, or write an entry there",
                    one.file, one.vector_id));
  for (const Decision& cited : one.decisions) {
    if (find(set.decisions, cited.id)) continue;
    problems.push_back(fmt::format("{}: {}: {}", one.file, one.vector_id, unknown(cited.id, set)));
  }
}

}  // namespace

std::vector<Decision> read_decisions(std::string_view markdown) {
  std::vector<Decision> decisions;
  bool begun = false;  // the line before was a heading
  while (!markdown.empty()) {
    const std::string_view line = markdown.substr(0, markdown.find('\n'));
    markdown.remove_prefix(std::min(line.size() + 1, markdown.size()));
    if (begun && !line.starts_with('#')) decisions.back().sentence = line;
    begun = line.starts_with(heading);
    if (begun) decisions.push_back({std::string(line.substr(heading.size())), {}});
  }
  return decisions;
}

void load_decisions(const std::filesystem::path& file, VectorSet& set) {
  if (!std::filesystem::exists(file)) return;
  const Result<std::string> text = results::read_whole_file(file);
  if (!text) {
    set.problems.push_back(text.error().message);
    return;
  }
  std::set<std::string> here;
  for (Decision& decision : read_decisions(*text)) {
    if (!here.insert(decision.id).second)
      set.problems.push_back(
          fmt::format("{}: the id {} is used twice", file.filename().string(), decision.id));
    else if (!find(set.decisions, decision.id))
      set.decisions.push_back(std::move(decision));
  }
  for (std::vector<Case>* cases : {&set.cases, &set.tables})
    for (Case& one : *cases)
      for (Decision& cited : one.decisions)
        if (const Decision* decision = find(set.decisions, cited.id)) cited = *decision;
}

std::vector<std::string> lint_decisions(const VectorSet& set) {
  std::vector<std::string> problems;
  lint_entries(set, problems);
  std::set<std::string_view> seen;  // a vector's cases cite the same
  for (const std::vector<Case>* cases : {&set.cases, &set.tables})
    for (const Case& one : *cases)
      if (seen.insert(one.vector_id).second) lint_case(one, set, problems);
  return problems;
}

Status check_binding(const Binding& binding, const VectorSet& set) {
  for (const std::string& id : binding.named)
    if (!find(set.decisions, id)) return fail(unknown(id, set));
  return ok();
}

}  // namespace fieldproof::vectors
