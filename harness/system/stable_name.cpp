#include "harness/system/stable_name.hpp"

#include <algorithm>
#include <filesystem>
#include <vector>

namespace fieldproof::os {

std::string stable_name(const std::string& path, const std::string& folder) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  if (fs::is_symlink(path, ignored)) return {};  // a name that somebody chose
  std::vector<std::string> names;
  for (const fs::directory_entry& link : fs::directory_iterator(folder, ignored))
    if (fs::equivalent(link.path(), path, ignored)) names.push_back(link.path().string());
  return names.empty() ? std::string() : *std::ranges::min_element(names);
}

}  // namespace fieldproof::os
