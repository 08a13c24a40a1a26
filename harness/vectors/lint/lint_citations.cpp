// Rules of citation against cases.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>
#include <unordered_map>

#include "harness/vectors/citations.hpp"
#include "harness/vectors/filter.hpp"
#include "harness/vectors/in_threads.hpp"
#include "harness/vectors/json/files.hpp"
#include "harness/vectors/lint/citation_rules.hpp"
#include "src/base/json_trouble.hpp"

namespace fieldproof::vectors {

namespace fs = std::filesystem;

namespace {

/// What a step says, as a rule sees it: notation, "ADDRESS=DIGITS", an action.
std::vector<std::string> texts_of(const Step& step) {
  std::vector<std::string> texts;
  for (const Frame& frame : step.frames)
    texts.push_back(frame.body.empty() ? frame.text : frame.body);
  for (const auto& [address, digits] : step.memory) texts.push_back(address + '=' + digits);
  for (const CheckedValues& other : step.alternatives)
    for (std::size_t i = 0; i < other.digits.size(); ++i)
      texts.push_back(step.memory.at(i).first + '=' + other.digits[i]);
  if (!step.action.empty()) texts.push_back(step.action);
  return texts;
}

/// Most of what is cited is an id, not a glob over ids.
bool is_one_of(std::string_view id, const std::string& glob) {
  return glob.find_first_of("*?:") == std::string::npos ? id == glob : matches_filter(id, glob);
}

/// A case as rules see it.
struct Seen {
  const Case* one = nullptr;
  bool client = false;
  std::vector<std::pair<Step::Kind, std::size_t>> says;  // by the number of the text
  std::vector<std::string_view> cited;
};

/// All cases, by the folder with which their ids begin. Many say the same: a text has one number.
class SeenCases {
 public:
  explicit SeenCases(const std::vector<Case>& cases) {
    for (const Case& one : cases)
      folders_[one.id.substr(0, one.id.find('/') + 1)].push_back(seen(one));
  }
  const std::map<std::string, std::vector<Seen>>& folders() const { return folders_; }
  const std::vector<const std::string*>& texts() const { return texts_; }

 private:
  Seen seen(const Case& one) {
    Seen result{&one, is_client_case(one), {}, cited_by(one)};
    for (const Step& step : one.steps)
      for (std::string& text : texts_of(step)) {
        const auto [known, is_new] = numbers_.emplace(std::move(text), texts_.size());
        if (is_new) texts_.push_back(&known->first);
        result.says.emplace_back(step.kind, known->second);
      }
    return result;
  }

  std::map<std::string, std::vector<Seen>> folders_;
  std::unordered_map<std::string, std::size_t> numbers_;
  std::vector<const std::string*> texts_;
};

/// A rule against all cases.
class Application {
 public:
  Application(const CitationRule& rule, const SeenCases& cases)
      : rule_(rule), cases_(cases), known_(cases.texts().size()) {
    for (const auto& [folder, all] : cases.folders())
      if (rule.cases.empty() || may_match_filter(folder, rule.cases))
        for (const Seen& one : all) apply(one);
    if (!met_)
      problems.push_back(
          fmt::format("{}: {}: no step of a case matches '{}'; correct it or take the rule out",
                      rule.at, rule.id, rule.pattern));
  }

  std::vector<std::string> problems;

 private:
  void apply(const Seen& seen) {
    const Case& one = *seen.one;
    if (!rule_.role.empty() && seen.client != (rule_.role == "client")) return;
    if (!matches_filter(one.id, rule_.cases) || !meets(seen)) return;
    met_ = true;
    const std::string lacks = lacking(seen);
    // The cases of a vector lack the same, mostly.
    if (!lacks.empty() && told_.insert(one.vector_id + lacks).second)
      problems.push_back(fmt::format("{}: {}: {}: {} ({}, {})", one.file, one.id, rule_.says, lacks,
                                     rule_.id, rule_.at));
  }

  bool meets(const Seen& seen) {
    return std::ranges::any_of(seen.says, [&](const auto& says) {
      const auto& [kind, text] = says;
      return std::ranges::find(rule_.steps, kind) != rule_.steps.end() && matches(text);
    });
  }

  /// Each text is searched once.
  bool matches(std::size_t text) {
    if (!known_[text])
      known_[text] =
          std::regex_search(*cases_.texts()[text], rule_.matches, rule_.where) ? yes : no;
    return known_[text] == yes;
  }

  std::string lacking(const Seen& seen) const {
    std::vector<std::string> lacks;
    for (const std::vector<std::string>& any : rule_.cite)
      if (std::ranges::none_of(any, [&](const std::string& glob) {
            return std::ranges::any_of(seen.cited,
                                       [&](std::string_view id) { return is_one_of(id, glob); });
          }))
        lacks.push_back(fmt::format("cites no {}", fmt::join(any, " or ")));
    const std::vector<Decision>& named = seen.one->decisions;
    for (const std::string& id : rule_.decide)
      if (std::ranges::find(named, id, &Decision::id) == named.end())
        lacks.push_back(fmt::format("names no decision {}", id));
    return fmt::format("{}", fmt::join(lacks, ", "));
  }

  static constexpr char yes = 1, no = 2;
  const CitationRule& rule_;
  const SeenCases& cases_;
  bool met_ = false;
  std::vector<char> known_;  // by text: yes, no, 0 where it was not searched
  std::set<std::string> told_;
};

/// What a rule asks for that there is not.
std::vector<std::string> unknowns(const CitationRule& rule, const VectorSet& set,
                                  const StatementsById& known) {
  std::vector<std::string> problems;
  const auto problem = [&](const std::string& what) {
    problems.push_back(fmt::format("{}: {}: {}", rule.at, rule.id, what));
  };
  for (const std::vector<std::string>& any : rule.cite)
    for (const std::string& glob : any)
      if (!known.contains(glob) &&
          std::ranges::none_of(known, [&](const auto& one) { return is_one_of(one.first, glob); }))
        problem(no_statement(glob, known));
  for (const std::string& id : rule.decide)
    if (std::ranges::find(set.decisions, id, &Decision::id) == set.decisions.end())
      problem(fmt::format("no decision '{}' in DECISIONS.md", id));
  return problems;
}

std::vector<std::string> broken_rules(const std::vector<CitationRule>& rules,
                                      const VectorSet& set) {
  const SeenCases cases(set.cases);
  const StatementsById known = statements_by_id(set);
  std::vector<std::vector<std::string>> found(rules.size());
  in_threads(rules.size(), [&](std::size_t i) {
    found[i] = unknowns(rules[i], set, known);
    std::ranges::move(Application(rules[i], cases).problems, std::back_inserter(found[i]));
  });
  std::vector<std::string> problems;
  for (std::vector<std::string>& some : found)
    std::ranges::move(some, std::back_inserter(problems));
  return problems;
}

}  // namespace

std::vector<std::string> lint_citation_rules(const fs::path& folder, const VectorSet& set) {
  if (!fs::is_directory(folder / "citations")) return {};
  std::vector<std::string> problems;
  std::vector<CitationRule> rules;
  std::set<std::string> ids;
  for (const fs::path& path : json_files(folder / "citations")) {
    const std::string name = fs::relative(path, folder).generic_string();
    try {
      std::ranges::move(read_citation_rules(text_of_file(path), name), std::back_inserter(rules));
    } catch (const std::exception& error) {
      problems.push_back(fmt::format("{}: {}", name, json_trouble(error)));
    }
  }
  for (const CitationRule& rule : rules)
    if (!ids.insert(rule.id).second)
      problems.push_back(fmt::format("{}: the rule {} stands twice", rule.at, rule.id));
  std::ranges::move(broken_rules(rules, set), std::back_inserter(problems));
  return problems;
}

}  // namespace fieldproof::vectors
