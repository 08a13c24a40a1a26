#include "reports/errata.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <nlohmann/json.hpp>

#include "reports/html/html_survey.hpp"
#include "reports/text/markdown_text.hpp"

namespace fieldproof::reports {

using results::ErratumInfo;

void sort_errata(std::vector<ErratumInfo>& errata) {
  std::ranges::stable_sort(errata, std::less<>{}, [](const ErratumInfo& one) {
    return html::SectionName{one.manual, one.section};
  });
}

std::string errata_text(const std::vector<ErratumInfo>& errata) {
  std::string text;
  for (const ErratumInfo& one : errata)
    text += fmt::format("{} {}\n  printed: {}\n  correct: {}\n  why:     {}\n  vector:  {}\n\n",
                        one.manual, one.section, one.printed, one.correct, one.why, one.vector_id);
  return text + fmt::format("{} errata\n", errata.size());
}

std::string errata_json(const std::vector<ErratumInfo>& errata) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const ErratumInfo& one : errata)
    all.push_back({{"manual", one.manual},
                   {"section", one.section},
                   {"printed", one.printed},
                   {"correct", one.correct},
                   {"why", one.why},
                   {"vector", one.vector_id}});
  return all.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + '\n';
}

std::string errata_markdown(const std::vector<ErratumInfo>& errata) {
  std::string text = fmt::format("# Errata of the manuals\n\n{} errata\n", errata.size());
  const std::string* manual = nullptr;
  for (const ErratumInfo& one : errata) {
    if (!manual || *manual != one.manual)
      text += fmt::format("\n## {}\n\n{}", text::markdown_cell(one.manual),
                          text::markdown_head({"section", "printed", "correct", "why", "vector"}));
    manual = &one.manual;
    text += text::markdown_row({one.section, one.printed, one.correct, one.why, one.vector_id});
  }
  return text;
}

}  // namespace fieldproof::reports
