#include "harness/paths.hpp"

#include <cstdlib>

namespace fieldproof::harness {

namespace fs = std::filesystem;

fs::path own_executable() {
  std::error_code ignored;
  return fs::read_symlink("/proc/self/exe", ignored);
}

DataPaths find_data() {
  const auto in = [](const fs::path& folder) {
    return DataPaths{folder / "vectors", folder / "profiles", folder / "definitions"};
  };
  if (const char* data = std::getenv("FIELDPROOF_DATA"); data && *data) return in(data);
  const fs::path installed = own_executable().parent_path().parent_path() / "share" / "fieldproof";
  if (fs::is_directory(installed / "vectors")) return in(installed);
  const fs::path source = FIELDPROOF_SOURCE_DIR;
  return {source / "vectors", source / "suites" / "profiles",
          source / "suites" / "user_frames" / "definitions"};
}

}  // namespace fieldproof::harness
