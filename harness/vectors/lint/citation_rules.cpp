#include "harness/vectors/lint/citation_rules.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <nlohmann/json.hpp>

#include "harness/vectors/case_reader.hpp"
#include "harness/vectors/json/broken.hpp"
#include "harness/vectors/json/pieces.hpp"
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
                    std::regex_constants::match_default,
                    {},
                    {},
                    std::move(at)};
  rule.matches = regex_of(rule.pattern);
  // std::regex tries every place of a text, else.
  if (begins_text(rule.pattern)) rule.where = std::regex_constants::match_continuous;
  for (const std::string& word : one_or_more(value["step"])) rule.steps.push_back(step_kind(word));
  for (const json& one : value.value("cite", json::array())) rule.cite.push_back(one_or_more(one));
  rule.decide = one_or_more(value.value("decide", json::array()));
  if (rule.cite.empty() && rule.decide.empty())
    throw Broken("asks for nothing: it needs \"cite\", \"decide\" or both");
  return rule;
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

}  // namespace fieldproof::vectors
