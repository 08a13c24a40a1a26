#include "reports/results/ndjson.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <nlohmann/json.hpp>

#include "reports/results/file_error.hpp"

namespace fieldproof::results {
namespace {

using nlohmann::json;

/// Only a regular file can be locked and emptied: a pipe or /dev/stdout takes the lines as well.
bool is_regular(int fd) {
  struct stat info {};
  return ::fstat(fd, &info) == 0 && S_ISREG(info.st_mode);
}

template <typename T>
std::string line_of(const char* key, const T& value) {
  return json{{key, value}}.dump(-1, ' ', false, json::error_handler_t::replace) + '\n';
}

/// The state of a file while it is read.
class Reader {
 public:
  Reader(const std::string& path, const std::function<void(const CaseResult&)>& on_result)
      : path_(path), on_result_(on_result) {}

  Result<RunLog> read() {
    errno = 0;
    std::ifstream file(path_, std::ios::binary);
    if (!file) return file_error("read", path_, errno);
    std::string line;
    while (std::getline(file, line)) {
      ++number_;
      const bool complete = !file.eof();  // a line break ended it
      if (Status taken = take(line, complete); !taken) return taken.error();
    }
    if (file.bad()) return file_error("read", path_, errno != 0 ? errno : EIO);
    if (number_ == 0 || (log_.truncated && number_ == 1)) {
      return fail(fmt::format(
          "cannot read {}: no complete line is in it; the run was killed before it began", path_));
    }
    return std::move(log_);
  }

 private:
  Status take(const std::string& line, bool complete) {
    const json parsed = json::parse(line, nullptr, false);
    if (parsed.is_discarded()) {
      if (complete) return damaged("it is not JSON");
      log_.truncated = true;
      return ok();
    }
    if (!parsed.is_object() || parsed.size() != 1)
      return damaged("it is not one of run, case, sample, soak, end");
    try {
      return take(parsed.begin().key(), parsed.begin().value());
    } catch (const json::exception& error) {
      return damaged(error.what());
    }
  }

  Status take(const std::string& key, const json& value) {
    if ((key == "run") != (number_ == 1))
      return damaged("the line 'run' must be the first, and the first only");
    if (log_.end) return damaged("nothing may follow the line 'end'");
    if (key == "run") {
      value.get_to(log_.run);
    } else if (key == "case") {
      const auto result = value.get<CaseResult>();
      ++log_.results;
      on_result_(result);
    } else if (key == "sample") {
      log_.samples.push_back(value.get<SoakSample>());
    } else if (key == "soak") {
      log_.soak = value.get<SoakSummary>();
    } else if (key == "end") {
      log_.end = value.get<RunEnd>();
    } else {
      return damaged(fmt::format("unknown key '{}'", key));
    }
    return ok();
  }

  Status damaged(const std::string& cause) const {
    return fail(fmt::format("cannot read {}, line {}: {}; repair or remove the line", path_,
                            number_, cause));
  }

  const std::string& path_;
  const std::function<void(const CaseResult&)>& on_result_;
  RunLog log_;
  std::size_t number_ = 0;
};

}  // namespace

Result<NdjsonWriter> NdjsonWriter::create(const std::string& path) {
  const int fd = ::open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (fd < 0) return file_error("write", path, errno);
  NdjsonWriter writer(path, fd);
  if (is_regular(fd)) {
    // Locked before it is emptied: the lines of a run that is still writing are not ours to remove.
    if (::flock(fd, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
      return file_error("write", path, errno);
    if (::ftruncate(fd, 0) != 0) return file_error("empty", path, errno);
  }
  return writer;
}

NdjsonWriter::NdjsonWriter(NdjsonWriter&& other) noexcept { swap(other); }

NdjsonWriter& NdjsonWriter::operator=(NdjsonWriter&& other) noexcept {
  swap(other);
  return *this;
}

NdjsonWriter::~NdjsonWriter() {
  if (fd_ >= 0) ::close(fd_);
}

void NdjsonWriter::swap(NdjsonWriter& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(fd_, other.fd_);
}

Status NdjsonWriter::write(const RunInfo& info) { return write_line(line_of("run", info)); }
Status NdjsonWriter::write(const CaseResult& result) { return write_line(line_of("case", result)); }
Status NdjsonWriter::write(const SoakSample& sample) {
  return write_line(line_of("sample", sample));
}
Status NdjsonWriter::write(const SoakSummary& soak) { return write_line(line_of("soak", soak)); }
Status NdjsonWriter::write(const RunEnd& end) { return write_line(line_of("end", end)); }

Status NdjsonWriter::write_line(const std::string& line) {
  std::size_t done = 0;
  while (done < line.size()) {
    const ssize_t count = ::write(fd_, line.data() + done, line.size() - done);
    if (count >= 0) {
      done += static_cast<std::size_t>(count);
    } else if (errno != EINTR) {
      const int error = errno;
      // A disk that is full took half a line: take it back, or the next line would be glued to it.
      struct stat info {};
      if (done > 0 && ::fstat(fd_, &info) == 0 && S_ISREG(info.st_mode)) {
        [[maybe_unused]] const int rc = ::ftruncate(fd_, info.st_size - static_cast<off_t>(done));
      }
      return file_error("write", path_, error);
    }
  }
  return ok();
}

Result<RunLog> read_ndjson(const std::string& path,
                           const std::function<void(const CaseResult&)>& on_result) {
  return Reader(path, on_result).read();
}

}  // namespace fieldproof::results
