#include "reports/results/sha256.hpp"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <fstream>
#include <new>
#include <vector>

#include "reports/results/file_error.hpp"

namespace fieldproof::results {
namespace {

namespace fs = std::filesystem;

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

struct Sha256::State {
  std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context{EVP_MD_CTX_new(),
                                                                  &EVP_MD_CTX_free};
};

Sha256::Sha256() : state_(std::make_unique<State>()) {
  if (EVP_DigestInit_ex(state_->context.get(), EVP_sha256(), nullptr) != 1) throw std::bad_alloc();
}
Sha256::Sha256(Sha256&&) noexcept = default;
Sha256& Sha256::operator=(Sha256&&) noexcept = default;
Sha256::~Sha256() = default;

void Sha256::add(std::string_view bytes) {
  EVP_DigestUpdate(state_->context.get(), bytes.data(), bytes.size());
}

std::string Sha256::digits() const {
  const State copy;  // more may follow
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned size = 0;
  if (EVP_MD_CTX_copy_ex(copy.context.get(), state_->context.get()) != 1) throw std::bad_alloc();
  EVP_DigestFinal_ex(copy.context.get(), digest.data(), &size);
  std::string text;
  for (unsigned i = 0; i < size; ++i) text += fmt::format("{:02x}", digest[i]);
  return text;
}

std::string sha256_of(std::string_view bytes) {
  Sha256 sum;
  sum.add(bytes);
  return sum.digits();
}

Result<std::string> sha256_of_file(const fs::path& path) {
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) return file_error("read", path.string(), errno);
  Sha256 sum;
  std::vector<char> piece(std::size_t{1} << 16);
  while (file.read(piece.data(), static_cast<std::streamsize>(piece.size())) || file.gcount() > 0)
    sum.add({piece.data(), static_cast<std::size_t>(file.gcount())});
  if (file.bad()) return file_error("read", path.string(), errno != 0 ? errno : EIO);
  return sum.digits();
}

Result<std::string> sha256_of_tree(const fs::path& path) {
  if (!fs::is_directory(path)) return sha256_of_file(path);
  auto names = files_of(path);
  if (!names) return names.error();
  Sha256 list;
  for (const std::string& name : *names) {
    auto digits = sha256_of_file(path / name);
    if (!digits) return digits.error();
    list.add(*digits + "  " + name + '\n');
  }
  return list.digits();
}

}  // namespace fieldproof::results
