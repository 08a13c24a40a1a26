#include "harness/cli/case_lines.hpp"

#include <fmt/format.h>
#include <algorithm>

#include "reports/text/fold.hpp"

namespace fieldproof::cli {

namespace {

constexpr std::size_t usual_id = 58, least_title = 12;

}  // namespace

std::string case_lines(const std::vector<const vectors::Case*>& cases, int columns) {
  std::string text;
  if (columns == 0) {
    for (const vectors::Case* one : cases)
      text += fmt::format("{:<{}} {:<6} {:<13} {}\n", one->id, usual_id, one->level, one->basis,
                          one->title);
    return text;
  }
  const auto width = static_cast<std::size_t>(columns);
  std::size_t id_width = 0;
  for (const vectors::Case* one : cases) id_width = std::max(id_width, one->id.size());
  id_width = std::min({id_width, usual_id, width * 3 / 5});
  for (const vectors::Case* one : cases) {
    const std::string id = fmt::format("{:<{}}  ", one->id, id_width);
    if (id.size() + least_title <= width)
      text += id + text::cut(one->title, width - id.size());
    else
      text += one->id;
    text += '\n';
  }
  return text;
}

}  // namespace fieldproof::cli
