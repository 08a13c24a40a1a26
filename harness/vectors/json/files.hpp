// The JSON files of a folder of vectors.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace fieldproof::vectors {

/// All below a folder, sorted by path; the one file that `folder` may be.
std::vector<std::filesystem::path> json_files(const std::filesystem::path& folder);

/// The text of a file; throws Broken.
std::string text_of_file(const std::filesystem::path& path);

}  // namespace fieldproof::vectors
