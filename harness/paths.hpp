// Where the tool finds its vectors and profiles: beside the installed tool, else in the source tree
// it was built from.
#pragma once

#include <filesystem>

namespace fieldproof::harness {

struct DataPaths {
  std::filesystem::path vectors;  // with schema.json, manuals.json, statements/, quotes.lock
  std::filesystem::path profiles;
  std::filesystem::path definitions;  // of user-defined frames
};

/// FIELDPROOF_DATA (a folder with vectors/, profiles/ and definitions/) comes first.
DataPaths find_data();

/// The running program itself.
std::filesystem::path own_executable();

}  // namespace fieldproof::harness
