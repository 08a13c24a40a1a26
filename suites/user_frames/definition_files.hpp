// Where definitions come from: the shipped ones by name, a user's own by path.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "src/base/result.hpp"
#include "src/user_frames/frame.hpp"

namespace fieldproof::user_frames_suite {

struct NamedDefinition {
  std::string name;  // "px7", the model
  user_frames::FrameDefinition definition;
};

/// The folder of the shipped definitions: beside the installed tool's vectors, else in the source
/// tree.
std::filesystem::path definitions_folder();

/// Names of the files of a folder, in alphabetical order: "px7", "px7_controller", "xgt_write".
std::vector<std::string> definition_names(const std::filesystem::path& folder);

/// Is a model the path of a file, not the name of a shipped definition?
bool is_definition_path(std::string_view model);

/// The definition of a model: a name, or a path that ends in .json. Errors name the file, and
/// suggest a near name.
Result<NamedDefinition> load_definition(std::string_view model,
                                        const std::filesystem::path& folder);

/// All shipped definitions that can be read.
std::vector<NamedDefinition> load_definitions(const std::filesystem::path& folder);

}  // namespace fieldproof::user_frames_suite
