#include "reports/errata.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>

#include "reports/html/html_survey.hpp"
#include "reports/text/markdown_text.hpp"

namespace fieldproof::reports {

using results::ErratumInfo;
using results::Passage;
using json = nlohmann::ordered_json;

namespace {

/// "183 errata: 24 wrong bytes, 31 wording".
std::string count_line(const std::vector<ErratumInfo>& errata) {
  std::map<std::string_view, int> kinds;
  for (const ErratumInfo& one : errata) ++kinds[one.kind];
  std::string line;
  for (const auto& [kind, count] : kinds)
    line += fmt::format("{} {} {}", line.empty() ? ":" : ",", count, kind);
  return fmt::format("{} errata{}", errata.size(), line);
}

/// "7.1.5 (1)(b); xgb-cnet-ko-2.1 7.2.1": the first place stands under the heading of its manual.
std::string places(const ErratumInfo& erratum, const std::string& manual) {
  std::vector<std::string> all;
  for (const Passage& one : erratum.places) {
    std::string place = one.manual == manual ? one.section : one.manual + " " + one.section;
    if (std::ranges::find(all, place) == all.end()) all.push_back(std::move(place));
  }
  return fmt::format("{}", fmt::join(all, "; "));
}

std::string cited(const Passage& passage) {
  return fmt::format("{} {}: \"{}\"", passage.manual, passage.section, passage.quote);
}

std::string proof(const ErratumInfo& erratum) {
  std::vector<std::string> all;
  for (const Passage& one : erratum.proof) all.push_back(cited(one));
  return fmt::format("{}. {}", erratum.why, fmt::join(all, " "));
}

json passages_json(const std::vector<Passage>& passages) {
  json all = json::array();
  for (const Passage& one : passages)
    all.push_back({{"manual", one.manual}, {"section", one.section}, {"quote", one.quote}});
  return all;
}

}  // namespace

void sort_errata(std::vector<ErratumInfo>& errata) {
  std::ranges::stable_sort(errata, std::less<>{}, html::first_place);
}

std::string errata_text(const std::vector<ErratumInfo>& errata) {
  std::string text;
  for (const ErratumInfo& one : errata) {
    text += fmt::format("{}: {}\n", one.id, one.kind);
    for (const Passage& place : one.places) text += fmt::format("  place:   {}\n", cited(place));
    text += fmt::format("  printed: {}\n  right:   {}\n", one.printed, one.right);
    for (const Passage& place : one.proof) text += fmt::format("  proof:   {}\n", cited(place));
    text += fmt::format("  why:     {}\n  effect:  {}\n", one.why, one.effect);
    if (!one.doubt.empty()) text += fmt::format("  doubt:   {}\n", one.doubt);
    text += '\n';
  }
  return text + count_line(errata) + '\n';
}

std::string errata_json(const std::vector<ErratumInfo>& errata) {
  json all = json::array();
  for (const ErratumInfo& one : errata) {
    json object{
        {"id", one.id},           {"kind", one.kind},    {"places", passages_json(one.places)},
        {"printed", one.printed}, {"right", one.right},  {"proof", passages_json(one.proof)},
        {"why", one.why},         {"effect", one.effect}};
    if (!one.doubt.empty()) object["doubt"] = one.doubt;
    all.push_back(std::move(object));
  }
  return all.dump(2, ' ', false, json::error_handler_t::replace) + '\n';
}

std::string errata_markdown(const std::vector<ErratumInfo>& errata) {
  std::string text = fmt::format("# Errata of the manuals\n\n{}\n", count_line(errata));
  std::string manual;
  for (const ErratumInfo& one : errata) {
    if (const std::string here = html::first_place(one).manual; here != manual || manual.empty()) {
      manual = here;
      text += fmt::format("\n## {}\n\n{}", text::markdown_cell(manual),
                          text::markdown_head({"section", "kind", "printed", "right", "proof",
                                               "what a reader would do wrong", "id"}));
    }
    const std::string doubt = one.doubt.empty() ? "" : fmt::format(" ({})", one.doubt);
    text += text::markdown_row({places(one, manual), one.kind, one.printed, one.right, proof(one),
                                one.effect + doubt, one.id});
  }
  return text;
}

}  // namespace fieldproof::reports
