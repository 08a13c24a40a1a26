#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <sstream>

#include "harness/vectors/fingerprint.hpp"
#include "harness/vectors/lint/lint.hpp"
#include "reports/results/whole_file.hpp"

namespace fieldproof::vectors {

namespace fs = std::filesystem;

namespace {

/// Every quote of the set with the id that carries it and its manual; a vector's quote once, not
/// for each of its cases.
struct Quote {
  std::string id, manual, text;
  std::string at{};    // "errata/cnet_7.json:12: ", of an erratum
  bool title = false;  // of a section: may be short

  std::string name() const { return at + id; }
};
std::vector<Quote> quotes(const VectorSet& set) {
  std::map<std::string, Quote> by_id;
  for (const Statement& statement : set.statements)
    by_id["statement " + statement.id] = {statement.id, statement.manual, statement.quote};
  for (const std::vector<Case>* cases : {&set.cases, &set.tables})
    for (const Case& one : *cases)
      by_id["vector " + one.id] = {one.id, one.source.manual, one.source.quote};
  for (const Erratum& one : set.errata)
    for (const std::vector<Passage>* list : {&one.places, &one.proof})
      for (const Passage& passage : *list)
        by_id[fmt::format("erratum {} {} {}", one.id, passage.manual, passage.quote)] = {
            one.id, passage.manual, passage.quote, one.at + ": "};
  for (const auto& [manual, titles] : set.sections)
    for (const auto& [number, title] : titles)
      by_id[fmt::format("title {} {}", manual, number)] = {fmt::format("{}/{}", manual, number),
                                                           manual, title, "sections.json: ", true};
  std::vector<Quote> result;
  std::set<std::pair<std::string, std::string>> seen;
  for (auto& [key, quote] : by_id)
    if (seen.emplace(quote.manual, quote.text).second) result.push_back(std::move(quote));
  return result;
}

std::string quote_hash(const Quote& quote) {
  return fmt::format("{:016x}", extend_fingerprint(empty_fingerprint,
                                                   quote.manual + '\n' + fold_space(quote.text)));
}

/// At least five words; a table row or a Korean sentence counts its words likewise, shorter ones
/// must be long in bytes.
bool long_enough(const std::string& quote) {
  const std::string folded = fold_space(quote);
  return std::ranges::count(folded, ' ') >= 4 || folded.size() >= 20;
}

}  // namespace

std::string fold_space(std::string_view text) {
  std::string folded;
  for (char c : text) {
    const bool space = c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\f';
    if (!space)
      folded += c;
    else if (!folded.empty() && folded.back() != ' ')
      folded += ' ';
  }
  if (folded.ends_with(' ')) folded.pop_back();
  return folded;
}

std::vector<std::string> lint_quotes(const VectorSet& set, const fs::path& folder) {
  std::vector<std::string> problems;
  std::map<std::string, std::string> texts;
  for (const Manual& manual : set.manuals) {
    const Result<std::string> text = results::read_whole_file(folder / manual.file);
    if (text && !text->empty()) texts[manual.id] = fold_space(*text);
  }
  for (const Quote& quote : quotes(set)) {
    const auto text = texts.find(quote.manual);
    if (text == texts.end())
      problems.push_back(fmt::format("{}: the text of {} is not in {}", quote.name(), quote.manual,
                                     folder.string()));
    else if (text->second.find(fold_space(quote.text)) == std::string::npos)
      problems.push_back(fmt::format("{}: the quote does not stand in {}: \"{}\"", quote.name(),
                                     quote.manual, quote.text));
    if (!quote.title && !long_enough(quote.text))
      problems.push_back(fmt::format("{}: the quote is shorter than five words: \"{}\"",
                                     quote.name(), quote.text));
  }
  return problems;
}

std::string quotes_lock(const VectorSet& set) {
  std::string lock;
  for (const Quote& quote : quotes(set))
    lock += fmt::format("{} {}\n", quote_hash(quote), quote.id);
  return lock;
}

std::vector<std::string> lint_lock(const VectorSet& set, const std::string& lock) {
  std::set<std::string> locked;
  std::istringstream in(lock);
  for (std::string line; std::getline(in, line);) locked.insert(line.substr(0, line.find(' ')));
  std::vector<std::string> problems;
  for (const Quote& quote : quotes(set))
    if (!locked.contains(quote_hash(quote)))
      problems.push_back(
          fmt::format("{}: the quote is not the one last verified against the manual; run "
                      "`fieldproof lint --manuals DIR --lock`",
                      quote.name()));
  return problems;
}

}  // namespace fieldproof::vectors
