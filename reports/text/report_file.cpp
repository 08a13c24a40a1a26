#include "reports/text/report_file.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "reports/results/file_error.hpp"

namespace fieldproof::text {
namespace {

bool written_in_place(const std::string& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  return std::filesystem::exists(status) && !std::filesystem::is_regular_file(status);
}

}  // namespace

ReportFile::ReportFile(std::string path, std::string temporary)
    : path_(std::move(path)),
      temporary_(std::move(temporary)),
      stream_(std::make_unique<std::ofstream>()) {}

Result<ReportFile> ReportFile::create(const std::string& path) {
  ReportFile file(
      path, written_in_place(path) ? path : path + "." + std::to_string(::getpid()) + ".part");
  errno = 0;
  file.stream_->open(file.temporary_, std::ios::binary | std::ios::trunc);
  if (!*file.stream_) return results::file_error("write", path, errno);
  return file;
}

ReportFile::~ReportFile() {
  if (!stream_ || temporary_ == path_) return;
  stream_->close();
  std::remove(temporary_.c_str());
}

Status ReportFile::commit() {
  errno = 0;
  stream_->close();
  if (!*stream_) return results::file_error("write", path_, errno != 0 ? errno : EIO);
  if (temporary_ != path_ && std::rename(temporary_.c_str(), path_.c_str()) != 0)
    return results::file_error("write", path_, errno);
  stream_.reset();
  return ok();
}

}  // namespace fieldproof::text
