// Reading a whole file.
#pragma once

#include <filesystem>
#include <string>

#include "src/base/result.hpp"

namespace fieldproof::results {

/// All bytes of a file. Errors name the file, the cause and what to do (file_error.hpp).
Result<std::string> read_whole_file(const std::filesystem::path& path);

}  // namespace fieldproof::results
