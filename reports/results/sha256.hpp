// SHA-256 of files, so that a qualification sheet says which files it speaks of.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "src/base/result.hpp"

namespace fieldproof::results {

/// Of bytes as they come.
class Sha256 {
 public:
  Sha256();
  Sha256(Sha256&&) noexcept;
  Sha256& operator=(Sha256&&) noexcept;
  ~Sha256();

  void add(std::string_view bytes);
  /// 64 hex digits, of what came so far.
  std::string digits() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Of bytes that are there.
std::string sha256_of(std::string_view bytes);

/// 64 hex digits, as `sha256sum PATH` prints them.
Result<std::string> sha256_of_file(const std::filesystem::path& path);

/// One figure for a folder: `cd PATH && find . -type f -printf '%P\n' | LC_ALL=C sort | xargs
/// sha256sum | sha256sum`. A single file is itself.
Result<std::string> sha256_of_tree(const std::filesystem::path& path);

}  // namespace fieldproof::results
