// Reading a whole file.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "src/base/result.hpp"

namespace fieldproof::results {

/// All bytes of a file. Errors name the file, the cause and what to do (file_error.hpp): "cannot
/// read KIND x.json: no such file or directory; check the path".
Result<std::string> read_whole_file(const std::filesystem::path& path, std::string_view kind = {});

}  // namespace fieldproof::results
