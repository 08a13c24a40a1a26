#include "harness/run/line_matrix.hpp"

#include <fmt/format.h>
#include <algorithm>

namespace fieldproof::run {

using line::LineSettings;

namespace {

constexpr std::string_view all_speeds = "1200,2400,4800,9600,19200,38400,57600,115200";
constexpr std::string_view all_frames = "7N1,7N2,7E1,7E2,7O1,7O2,8N1,8N2,8E1,8E2,8O1,8O2";

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = std::min(text.find_first_not_of(' '), text.size());
  return text.substr(begin, text.find_last_not_of(' ') + 1 - begin);
}

std::vector<std::string_view> parts_of(std::string_view list, std::string_view all) {
  list = trimmed(list);
  if (list == "all") list = all;
  std::vector<std::string_view> parts;
  for (std::size_t comma = 0; comma != std::string_view::npos;) {
    comma = list.find(',');
    parts.push_back(trimmed(list.substr(0, comma)));
    list.remove_prefix(comma == std::string_view::npos ? list.size() : comma + 1);
  }
  return parts;
}

}  // namespace

Result<std::vector<LineSettings>> parse_line_matrix(std::string_view text) {
  const auto wrong = [&](const std::string& why) {
    return fail(
        fmt::format("cannot read --matrix '{}': {}; write SPEEDS x FRAMES such as \"38400,115200 x "
                    "8N1,8E1\", or all",
                    text, why));
  };
  const std::string_view whole = trimmed(text) == "all" ? "all x all" : text;
  const std::size_t cross = whole.find('x');
  if (cross == std::string_view::npos) return wrong("there is no x between speeds and frames");
  std::vector<LineSettings> steps;
  for (const std::string_view speed : parts_of(whole.substr(0, cross), all_speeds)) {
    for (const std::string_view frame : parts_of(whole.substr(cross + 1), all_frames)) {
      const Result<LineSettings> step =
          line::parse_line_settings(fmt::format("{}-{}", speed, frame));
      if (!step) return wrong(step.error().message);
      if (std::ranges::find(steps, *step) != steps.end())
        return wrong(line::to_string(*step) + " stands there twice");
      steps.push_back(*step);
    }
  }
  return steps;
}

std::string matrix_text(const LineSettings& step) {
  std::string text = line::to_string(step);
  return text.replace(text.find('-'), 1, " x ");
}

}  // namespace fieldproof::run
