#include "harness/vectors/lint/citation_rules.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <unordered_map>

#include "harness/vectors/case_reader.hpp"
#include "harness/vectors/citations.hpp"
#include "harness/vectors/filter.hpp"
#include "harness/vectors/in_threads.hpp"
#include "harness/vectors/json/broken.hpp"
#include "harness/vectors/json/files.hpp"
#include "harness/vectors/json/pieces.hpp"
#include "src/base/json_trouble.hpp"
#include "src/base/nesting.hpp"

namespace fieldproof::vectors {

namespace rule_shapes {
namespace {

using Kind = Shape::Kind;

constexpr std::array<std::string_view, 5> step_words{"send", "expect", "set", "check", "do"};
constexpr std::array<std::string_view, 2> role_words{"server", "client"};
constexpr Shape text{.least = 1};
constexpr Shape sentence{.least = 10};
constexpr Shape texts{.kind = Kind::list, .least = 1, .items = &text};
constexpr Shape role{.words = role_words};
constexpr Shape step{.words = step_words};
constexpr Shape steps{.kind = Kind::list, .least = 1, .items = &step};
constexpr Shape step_or_steps{.words = step_words, .instead = &steps};
constexpr Shape statement{.least = 1, .instead = &texts};
constexpr Shape statements{.kind = Kind::list, .least = 1, .items = &statement};
constexpr std::array keys{Key{"rule", &text, true},    Key{"cases", &text},
                          Key{"role", &role},          Key{"step", &step_or_steps, true},
                          Key{"matches", &text, true}, Key{"cite", &statements},
                          Key{"decide", &texts},       Key{"says", &sentence, true}};
constexpr Shape rule{.kind = Kind::object, .keys = keys};

}  // namespace
}  // namespace rule_shapes

namespace {

using json = nlohmann::ordered_json;
namespace fs = std::filesystem;

/// A text, or a list of texts.
std::vector<std::string> one_or_more(const json& value) {
  if (value.is_string()) return {value.get<std::string>()};
  return value.get<std::vector<std::string>>();
}

/// A text matches from its beginning or not at all: "^" stands before all alternatives.
bool begins_text(std::string_view pattern) {
  int depth = 0;
  bool in_class = false;
  for (std::size_t i = 0; i < pattern.size(); ++i) {
    const char c = pattern[i];
    if (c == '\\')
      ++i;
    else if (in_class)
      in_class = c != ']';
    else if (c == '[')
      in_class = true;
    else if (c == '(' || c == ')')
      depth += c == '(' ? 1 : -1;
    else if (c == '|' && depth == 0)
      return false;
  }
  return pattern.starts_with('^');
}

/// Of a pattern that begins with "^": the characters that every text begins with.
std::string literal_beginning(std::string_view pattern) {
  std::string beginning;
  for (std::size_t i = 1; i < pattern.size(); ++i) {
    const bool escaped = pattern[i] == '\\' && i + 1 < pattern.size();
    if (escaped ? std::isalnum(static_cast<unsigned char>(pattern[i + 1])) != 0
                : std::string_view("^$\\.*+?()[]{}|").find(pattern[i]) != pattern.npos)
      break;
    if (escaped) ++i;
    if (i + 1 < pattern.size() && std::string_view("*?{").find(pattern[i + 1]) != pattern.npos)
      break;
    beginning += pattern[i];
  }
  return beginning;
}

std::regex regex_of(const std::string& pattern) {
  try {
    return std::regex(pattern, std::regex::ECMAScript | std::regex::optimize);
  } catch (const std::regex_error& error) {
    throw Broken(fmt::format("matches: '{}' is no regular expression: {}", pattern, error.what()));
  }
}

CitationRule rule_of(const json& value, std::string at) {
  CitationRule rule{value["rule"],
                    value["says"],
                    value.value("cases", ""),
                    value.value("role", ""),
                    {},
                    value["matches"],
                    {},
                    {},
                    {},
                    {},
                    std::move(at)};
  rule.matches = regex_of(rule.pattern);
  if (begins_text(rule.pattern)) rule.beginning = literal_beginning(rule.pattern);
  for (const std::string& word : one_or_more(value["step"])) rule.steps.push_back(step_kind(word));
  for (const json& one : value.value("cite", json::array())) rule.cite.push_back(one_or_more(one));
  rule.decide = one_or_more(value.value("decide", json::array()));
  if (rule.cite.empty() && rule.decide.empty())
    throw Broken("asks for nothing: it needs \"cite\", \"decide\" or both");
  return rule;
}

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
    if (!known_[text]) known_[text] = is_found(*cases_.texts()[text]) ? yes : no;
    return known_[text] == yes;
  }

  /// std::regex is slow, and tries every place of a text unless it is told not to.
  bool is_found(const std::string& text) const {
    if (!rule_.beginning) return std::regex_search(text, rule_.matches);
    return text.starts_with(*rule_.beginning) &&
           std::regex_search(text, rule_.matches, std::regex_constants::match_continuous);
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

const Shape& citation_rule_shape() { return rule_shapes::rule; }

std::vector<CitationRule> read_citation_rules(std::string_view file_text, const std::string& file) {
  std::vector<CitationRule> rules;
  for (const Piece& piece : pieces_of(file_text, "a file of rules")) {
    const json value = json::parse(not_too_deep(piece.text));
    const std::vector<std::string> problems = shape_problems(value, citation_rule_shape());
    if (!problems.empty())
      throw Broken(fmt::format("line {}: {}", piece.line, fmt::join(problems, "; ")));
    rules.push_back(rule_of(value, fmt::format("{}:{}", file, piece.line)));
  }
  return rules;
}

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
