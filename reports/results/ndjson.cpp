#include "reports/results/ndjson.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "reports/results/file_error.hpp"
#include "reports/results/result_json.hpp"
#include "src/base/json_trouble.hpp"
#include "src/base/nesting.hpp"

namespace fieldproof::results {
namespace {

using nlohmann::json;

/// Only a regular file can be locked and emptied: a pipe or /dev/stdout takes the lines as well.
bool is_regular(int fd) {
  struct stat info {};
  return ::fstat(fd, &info) == 0 && S_ISREG(info.st_mode);
}

/// The state of a file while it is read.
class Reader {
 public:
  Reader(const std::string& path, Sink& sink) : path_(path), sink_(sink) {}

  Result<RunLog> read() {
    errno = 0;
    std::ifstream file(path_, std::ios::binary);
    if (!file) return file_error("read", path_, errno);
    std::string line;
    while (std::getline(file, line)) {
      ++number_;
      const bool complete = !file.eof();  // a line break ended it
      sha256_.add(line);
      if (complete) sha256_.add("\n");
      if (Status taken = take(line, complete); !taken) return taken.error();
    }
    if (file.bad()) return file_error("read", path_, errno != 0 ? errno : EIO);
    if (number_ == 0 || (log_.truncated && number_ == 1)) {
      return fail(fmt::format(
          "cannot read {}: no complete line is in it; the run was killed before it began", path_));
    }
    log_.sha256 = sha256_.digits();
    if (Status ended = sink_.end(log_); !ended) return ended.error();
    return std::move(log_);
  }

 private:
  Status take(const std::string& line, bool complete) {
    const json parsed = json::parse(not_too_deep(line), nullptr, false);
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
      return damaged(json_trouble(error));
    }
  }

  Status take(const std::string& key, const json& value) {
    if ((key == "run") != (number_ == 1))
      return damaged("the line 'run' must be the first, and the first only");
    if (log_.end) return damaged("nothing may follow the line 'end'");
    if (key == "run") {
      value.get_to(log_.run);
      return sink_.begin(log_.run);
    }
    if (key == "case") {
      const auto result = value.get<CaseResult>();
      ++log_.results;
      return sink_.add(Delivery(result));
    }
    if (key == "sample")
      log_.samples.push_back(value.get<SoakSample>());
    else if (key == "soak")
      log_.soak = value.get<SoakSummary>();
    else if (key == "end")
      log_.end = value.get<RunEnd>();
    else
      return damaged(fmt::format("unknown key '{}'", key));
    return ok();
  }

  Status damaged(const std::string& cause) const {
    return fail(fmt::format("cannot read {}, line {}: {}; repair or remove the line", path_,
                            number_, cause));
  }

  const std::string& path_;
  Sink& sink_;
  RunLog log_;
  Sha256 sha256_;
  std::size_t number_ = 0;
};

/// Results to a function.
class Callback final : public Sink {
 public:
  explicit Callback(const std::function<void(const CaseResult&)>& on_result)
      : on_result_(on_result) {}
  Status begin(const RunInfo&) override { return ok(); }
  Status add(const Delivery& one) override { return on_result_(*one), ok(); }
  Status end(const RunLog&) override { return ok(); }

 private:
  const std::function<void(const CaseResult&)>& on_result_;
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
  std::swap(sha256_, other.sha256_);
}

Status NdjsonWriter::begin(const RunInfo& run) {
  std::string json;
  append_json(json, run);
  return write_line("run", json);
}

Status NdjsonWriter::add(const Delivery& one) { return write_line("case", one.json()); }

Status NdjsonWriter::add(const SoakSample& sample) {
  std::string json;
  append_json(json, sample);
  return write_line("sample", json);
}

Status NdjsonWriter::add(const SoakSummary& soak) {
  std::string json;
  append_json(json, soak);
  return write_line("soak", json);
}

Status NdjsonWriter::end(const RunLog& log) {
  if (!log.end) return ok();
  std::string json;
  append_json(json, *log.end);
  return write_line("end", json);
}

Status NdjsonWriter::write_line(const char* key, const std::string& json) {
  line_.clear();
  fmt::format_to(std::back_inserter(line_), "{{\"{}\":{}}}\n", key, json);
  std::size_t done = 0;
  while (done < line_.size()) {
    const ssize_t count = ::write(fd_, line_.data() + done, line_.size() - done);
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
  sha256_.add(line_);
  return ok();
}

Result<RunLog> replay(const std::string& path, Sink& sink) { return Reader(path, sink).read(); }

Result<RunLog> read_ndjson(const std::string& path,
                           const std::function<void(const CaseResult&)>& on_result) {
  Callback sink(on_result);
  return replay(path, sink);
}

}  // namespace fieldproof::results
