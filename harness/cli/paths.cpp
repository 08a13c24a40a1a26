#include "harness/cli/paths.hpp"

#include <cstdlib>

namespace fieldproof {

namespace fs = std::filesystem;

fs::path own_executable() {
  std::error_code ignored;
  return fs::read_symlink("/proc/self/exe", ignored);
}

DataPaths find_data() {
  if (const char* data = std::getenv("FIELDPROOF_DATA"); data && *data) return {fs::path(data) / "vectors", fs::path(data) / "profiles"};
  const fs::path installed = own_executable().parent_path().parent_path() / "share" / "fieldproof";
  if (fs::is_directory(installed / "vectors")) return {installed / "vectors", installed / "profiles"};
  const fs::path source = FIELDPROOF_SOURCE_DIR;
  return {source / "vectors", source / "suites" / "profiles"};
}

}  // namespace fieldproof
