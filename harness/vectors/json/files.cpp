#include "harness/vectors/json/files.hpp"

#include <algorithm>

#include "harness/vectors/json/broken.hpp"
#include "reports/results/whole_file.hpp"

namespace fieldproof::vectors {

namespace fs = std::filesystem;

std::vector<fs::path> json_files(const fs::path& folder) {
  if (fs::is_regular_file(folder)) return {folder};
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder))
    if (entry.path().extension() == ".json" && entry.is_regular_file())
      files.push_back(entry.path());
  std::ranges::sort(files);
  return files;
}

std::string text_of_file(const fs::path& path) {
  Result<std::string> text = results::read_whole_file(path);
  if (!text) throw Broken(text.error().message);
  return std::move(*text);
}

}  // namespace fieldproof::vectors
