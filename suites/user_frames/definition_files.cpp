#include "suites/user_frames/definition_files.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "harness/paths.hpp"
#include "reports/results/whole_file.hpp"
#include "src/base/spelling.hpp"
#include "src/user_frames/definition.hpp"

namespace fieldproof::user_frames_suite {

namespace fs = std::filesystem;

namespace {
constexpr std::string_view extension = ".json";
}  // namespace

fs::path definitions_folder() { return harness::find_data().definitions; }

std::vector<std::string> definition_names(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored))
    if (entry.path().extension() == extension) names.push_back(entry.path().stem());
  std::ranges::sort(names);
  return names;
}

bool is_definition_path(std::string_view model) { return model.ends_with(extension); }

Result<NamedDefinition> load_definition(std::string_view model, const fs::path& folder) {
  const fs::path path = is_definition_path(model)
                            ? fs::path(model)
                            : folder / (std::string(model) + std::string(extension));
  const Result<std::string> text = results::read_whole_file(path);
  if (!text || text->empty()) {
    if (is_definition_path(model))
      return text ? fail(fmt::format("cannot read {}: it is empty", path.string())) : text.error();
    const std::vector<std::string> shipped = definition_names(folder);
    const std::vector<std::string_view> names(shipped.begin(), shipped.end());
    return fail(fmt::format(
        "there are no user-defined frames '{}'; use one of {}, or the path of a .json file{}",
        model, fmt::join(names, ", "), suggestion(model, names)));
  }
  Result<user_frames::FrameDefinition> definition =
      user_frames::parse_frame_definition(*text, path.filename());
  if (!definition) return definition.error();
  return NamedDefinition{path.stem(), std::move(*definition)};
}

std::vector<NamedDefinition> load_definitions(const fs::path& folder) {
  std::vector<NamedDefinition> all;
  for (const std::string& name : definition_names(folder))
    if (Result<NamedDefinition> one = load_definition(name, folder); one)
      all.push_back(std::move(*one));
  return all;
}

}  // namespace fieldproof::user_frames_suite
