#include "reports/text/spill.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <system_error>
#include <utility>

#include "reports/results/file_error.hpp"

namespace fieldproof::text {
namespace {

/// A file that nobody else sees. -1: see errno.
int open_nameless(const std::string& folder) {
  const int fd = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  if (fd >= 0 || (errno != EOPNOTSUPP && errno != EISDIR)) return fd;
  std::string name = folder + "/.fieldproof-XXXXXX";  // a file system that wants a name
  const int named = ::mkostemp(name.data(), O_CLOEXEC);
  if (named >= 0) ::unlink(name.c_str());
  return named;
}

/// Beside the report, where there must be room for it anyway; where it is no file (/dev/stdout), in
/// the folder of temporary files.
int open_beside(const std::string& path) {
  const std::string folder = std::filesystem::path(path).parent_path().string();
  const int fd = open_nameless(folder.empty() ? "." : folder);
  if (fd >= 0) return fd;
  std::error_code none;  // an unusable TMPDIR: /tmp, which says why it cannot be either
  const std::filesystem::path temporary = std::filesystem::temp_directory_path(none);
  return open_nameless(none ? "/tmp" : temporary.string());
}

}  // namespace

Spill::Spill(Spill&& other) noexcept
    : path_(std::move(other.path_)),
      text_(std::move(other.text_)),
      fd_(std::exchange(other.fd_, -1)) {}

Spill::~Spill() {
  if (fd_ >= 0) ::close(fd_);
}

Status Spill::append(std::string_view text) {
  text_ += text;
  return text_.size() < room ? ok() : flush();
}

Status Spill::flush() {
  if (fd_ < 0) fd_ = open_beside(path_);
  if (fd_ < 0) return results::file_error("write", path_, errno);
  for (std::string_view left = text_; !left.empty();) {
    const ssize_t count = ::write(fd_, left.data(), left.size());
    if (count >= 0)
      left.remove_prefix(static_cast<std::size_t>(count));
    else if (errno != EINTR)
      return results::file_error("write", path_, errno);
  }
  text_.clear();
  return ok();
}

Status Spill::copy_to(std::ostream& out) {
  std::string piece(fd_ < 0 ? 0 : room, '\0');
  for (off_t at = 0; fd_ >= 0;) {
    const ssize_t count = ::pread(fd_, piece.data(), piece.size(), at);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return results::file_error("read", path_, errno);
    if (count == 0) break;
    out.write(piece.data(), count);
    at += count;
  }
  out << text_;
  return ok();
}

}  // namespace fieldproof::text
