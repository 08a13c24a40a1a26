// Which statement a frame, a register or a flag of a vector rests on, wherever it stands
// (vectors/citations). A vector that is checked against a row of a table, and does not cite it,
// looks right to everybody but the reader who opens the manual.
#pragma once

#include <filesystem>
#include <regex>
#include <string>
#include <vector>

#include "harness/vectors/json/shape.hpp"
#include "harness/vectors/loader.hpp"

namespace fieldproof::vectors {

/// Where a step of a case says what `matches`, the case cites and names what follows.
struct CitationRule {
  std::string id, says;
  std::string cases;              // filter; empty: all
  std::string role;               // "client", "server"; empty: both
  std::vector<Step::Kind> steps;  // of these kinds
  std::string pattern;
  std::regex matches;  // searched in the texts of a step
  std::regex_constants::match_flag_type where =
      std::regex_constants::match_default;     // anywhere, or at the beginning alone
  std::vector<std::vector<std::string>> cite;  // of each list one; globs over ids of statements
  std::vector<std::string> decide;             // ids of decisions, all
  std::string at;                              // "citations/xgt_cnet.json:12", for messages
};

/// vectors/citations.schema.json says the same to editors, which a test holds to.
const Shape& citation_rule_shape();

/// The rules of one file; throws Broken.
std::vector<CitationRule> read_citation_rules(std::string_view file_text, const std::string& file);

/// What vectors break the rules of `folder`/citations, one line a vector and rule; rules that ask
/// for what there is not, or meet no step.
std::vector<std::string> lint_citation_rules(const std::filesystem::path& folder,
                                             const VectorSet& set);

}  // namespace fieldproof::vectors
