#include "reports/results/whole_file.hpp"

#include <cerrno>
#include <cstdio>
#include <memory>

#include "reports/results/file_error.hpp"

namespace fieldproof::results {

Result<std::string> read_whole_file(const std::filesystem::path& path, std::string_view kind) {
  const auto failed = [&] {
    return file_error(kind.empty() ? "read" : "read " + std::string(kind), path.string(), errno);
  };
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"),
                                                             &std::fclose);
  if (!file) return failed();
  std::string text;
  std::error_code unknown;
  if (const auto size = std::filesystem::file_size(path, unknown); !unknown) text.reserve(size);
  char piece[1 << 16];
  for (std::size_t n; (n = std::fread(piece, 1, sizeof piece, file.get())) > 0;)
    text.append(piece, n);
  if (std::ferror(file.get())) return failed();
  return text;
}

}  // namespace fieldproof::results
