#include "reports/results/sha256.hpp"

// libmd's headers want the BSD types before them.
#include <sys/types.h>

#include <sha256.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <vector>

#include "reports/results/file_error.hpp"

namespace fieldproof::results {
namespace {

namespace fs = std::filesystem;
using Digits = std::array<char, SHA256_DIGEST_STRING_LENGTH>;

std::string sha256_of_text(const std::string& text) {
  Digits digits{};
  return SHA256Data(reinterpret_cast<const std::uint8_t*>(text.data()), text.size(), digits.data());
}

/// Files below `folder`, relative to it, in the order of their bytes.
Result<std::vector<std::string>> files_of(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (fs::recursive_directory_iterator at(folder, error), end; !error && at != end;
       at.increment(error)) {
    if (at->is_regular_file(error)) names.push_back(at->path().lexically_relative(folder).string());
  }
  if (error) return file_error("read", folder.string(), error.value());
  std::ranges::sort(names);
  return names;
}

}  // namespace

Result<std::string> sha256_of_file(const fs::path& path) {
  Digits digits{};
  errno = 0;
  if (SHA256File(path.c_str(), digits.data()) == nullptr)
    return file_error("read", path.string(), errno);
  return std::string(digits.data());
}

Result<std::string> sha256_of_tree(const fs::path& path) {
  if (!fs::is_directory(path)) return sha256_of_file(path);
  auto names = files_of(path);
  if (!names) return names.error();
  std::string list;
  for (const std::string& name : *names) {
    auto digits = sha256_of_file(path / name);
    if (!digits) return digits.error();
    list += *digits + "  " + name + '\n';
  }
  return sha256_of_text(list);
}

}  // namespace fieldproof::results
