#include "harness/vectors/errata.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "harness/vectors/citations.hpp"
#include "harness/vectors/json/pieces.hpp"
#include "src/base/nesting.hpp"

namespace fieldproof::vectors {

/// Words for keys, types and texts of an erratum.
namespace errata_shapes {
namespace {

using Kind = Shape::Kind;

bool is_erratum_id(std::string_view id) {
  return id.find('/') != id.npos && !id.starts_with('/') && !id.ends_with('/') &&
         id.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_/") == id.npos;
}

constexpr Form erratum_id{"an id such as chapter_7/ack_tail",
                          "^[a-z0-9_][a-z0-9_/]*/[a-z0-9_/]*[a-z0-9_]$", is_erratum_id};
constexpr std::array<std::string_view, 5> kind_words{"wrong bytes", "contradiction", "wrong number",
                                                     "wrong reference", "wording"};
constexpr Shape id{.form = &erratum_id};
constexpr Shape kind{.words = kind_words};
constexpr Shape text{.least = 1};
constexpr Shape sentence{.least = 10};
constexpr Shape quote{.least = 5};
constexpr std::array passage_keys{Key{"manual", &text, true}, Key{"section", &text, true},
                                  Key{"quote", &quote, true}, Key{"statement", &text}};
constexpr Shape words{.kind = Kind::object, .keys = passage_keys};
constexpr Shape cited{.least = 1, .instead = &words};
constexpr Shape passages{.kind = Kind::list, .least = 1, .items = &cited};
constexpr std::array erratum_keys{
    Key{"id", &id, true},        Key{"kind", &kind, true},       Key{"places", &passages, true},
    Key{"printed", &text, true}, Key{"right", &text, true},      Key{"proof", &passages, true},
    Key{"why", &sentence, true}, Key{"effect", &sentence, true}, Key{"doubt", &sentence}};
constexpr Shape erratum{.kind = Kind::object, .keys = erratum_keys};

}  // namespace
}  // namespace errata_shapes

namespace {

using json = nlohmann::ordered_json;

std::vector<Passage> passages_of(const json& list) {
  std::vector<Passage> result;
  for (const json& one : list)
    if (one.is_string())
      result.push_back({one.get<std::string>(), {}, {}, {}});
    else
      result.push_back({one.value("statement", ""), one["manual"], one["section"], one["quote"]});
  return result;
}

Erratum read(const json& value, std::string at) {
  return {value["id"],
          value["kind"],
          value["printed"],
          value["right"],
          value["why"],
          value["effect"],
          value.value("doubt", ""),
          passages_of(value["places"]),
          passages_of(value["proof"]),
          std::move(at)};
}

/// What is wrong with a passage; empty: nothing.
std::string complaint(const Passage& passage, const VectorSet& set, const StatementsById& known) {
  if (!passage.statement.empty() && !known.contains(passage.statement))
    return no_statement(passage.statement, known);
  if (!passage.statement.empty() && known.at(passage.statement)->manual != passage.manual)
    return fmt::format("the statement {} is not of the manual {}", passage.statement,
                       passage.manual);
  if (std::ranges::none_of(set.manuals, [&](const Manual& m) { return m.id == passage.manual; }))
    return fmt::format("no manual '{}' in manuals.json", passage.manual);
  return {};
}

}  // namespace

const Shape& erratum_shape() { return errata_shapes::erratum; }

void load_errata(std::string_view file_text, const std::string& file, VectorSet& set) {
  for (const Piece& piece : pieces_of(file_text, "a file of errata")) {
    const std::string at = fmt::format("{}:{}", file, piece.line);
    const json value = json::parse(not_too_deep(piece.text));
    const std::vector<std::string> problems = shape_problems(value, erratum_shape());
    for (const std::string& problem : problems)
      set.problems.push_back(
          fmt::format("{}: {}: {}", at, piece.id.empty() ? "an erratum" : piece.id, problem));
    if (problems.empty()) set.errata.push_back(read(value, at));
  }
}

std::vector<std::string_view> statements_of(const Erratum& one) {
  std::vector<std::string_view> ids;
  for (const std::vector<Passage>* list : {&one.places, &one.proof})
    for (const Passage& passage : *list)
      if (!passage.statement.empty()) ids.push_back(passage.statement);
  return ids;
}

void resolve_errata(VectorSet& set) {
  const StatementsById known = statements_by_id(set);
  for (Erratum& one : set.errata)
    for (std::vector<Passage>* list : {&one.places, &one.proof})
      for (Passage& passage : *list) {
        const auto found = known.find(passage.statement);
        if (found == known.end() || !passage.quote.empty()) continue;
        const Statement& statement = *found->second;
        passage = {statement.id, statement.manual, statement.section, statement.quote};
      }
}

std::vector<std::string> lint_errata(const VectorSet& set) {
  std::vector<std::string> problems;
  const StatementsById known = statements_by_id(set);
  std::set<std::string_view> ids;
  for (const Erratum& one : set.errata) {
    const auto problem = [&](std::string_view what) {
      problems.push_back(fmt::format("{}: {}: {}", one.at, one.id, what));
    };
    if (!ids.insert(one.id).second) problem("the id is used twice");
    for (const std::vector<Passage>* list : {&one.places, &one.proof})
      for (std::size_t i = 0; i < list->size(); ++i)
        if (const std::string what = complaint((*list)[i], set, known); !what.empty())
          problem(fmt::format("{}[{}]: {}", list == &one.places ? "places" : "proof", i, what));
  }
  return problems;
}

}  // namespace fieldproof::vectors
