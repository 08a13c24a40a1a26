#include "harness/safety/journal.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "harness/endpoints/endpoint.hpp"
#include "reports/results/file_error.hpp"
#include "src/base/json_trouble.hpp"
#include "src/base/nesting.hpp"

namespace fieldproof::safety {

namespace {

using nlohmann::json;
namespace fs = std::filesystem;

json to_json(const OpenEntry& entry) {
  const JournalDevice& device = entry.device;
  return {{"number", entry.number},      {"endpoint", device.endpoint}, {"station", device.station},
          {"protocol", device.protocol}, {"model", device.model},       {"config", device.config},
          {"address", entry.address},    {"value", entry.value}};
}

OpenEntry entry_from(const json& value) {
  return {value.at("number"),
          {value.at("endpoint"), value.at("station"), value.at("protocol"), value.at("model"),
           value.at("config")},
          value.at("address"),
          value.at("value")};
}

std::string saved_line(const OpenEntry& entry) {
  return json{{"saved", to_json(entry)}}.dump() + '\n';
}

/// Closed entries are taken out of the file when it has so many lines of them, and as many as open
/// ones: writing it anew costs little for each.
constexpr std::size_t most_closed_lines = 2000;

struct Contents {
  std::vector<OpenEntry> open;
  std::uint64_t last_number = 0;
  std::uintmax_t size = 0;  // of the complete lines
  std::size_t lines = 0;
};

/// One line into `contents`; throws json::exception on a foreign shape.
void take(const json& line, Contents& contents) {
  if (line.contains("saved")) {
    contents.open.push_back(entry_from(line.at("saved")));
    contents.last_number = contents.open.back().number;
    return;
  }
  const std::uint64_t number = line.at("restored").at("number");
  std::erase_if(contents.open, [number](const OpenEntry& one) { return one.number == number; });
}

/// A line that a kill has cut off: so much of one of ours.
bool may_be_cut_off(std::string_view text) {
  constexpr std::string_view heads[] = {R"({"saved":{)", R"({"restored":{)"};
  return std::ranges::any_of(
      heads, [&](std::string_view head) { return text.starts_with(head.substr(0, text.size())); });
}

Result<Contents> read(const std::string& path) {
  Contents contents;
  std::ifstream in(path, std::ios::binary);
  if (!in) {
    if (!fs::exists(path)) return contents;
    return results::file_error("read", path, EACCES);
  }
  std::string text;
  for (std::size_t number = 1; std::getline(in, text) && !in.eof(); ++number) {
    try {
      take(json::parse(not_too_deep(text)), contents);
    } catch (const json::exception& error) {
      return fail(
          fmt::format("cannot read journal {}, line {}: {}; repair the line, it may be all that is "
                      "known of a device's values",
                      path, number, json_trouble(error)));
    }
    contents.size += text.size() + 1;
    contents.lines = number;
  }
  if (!may_be_cut_off(text))
    return fail(
        fmt::format("{} is no journal: its last line is none of one. A run keeps it in its "
                    "folder of reports, as journal.ndjson",
                    path));
  return contents;
}

/// All of it, or, where the disk is full, nothing: the next line is not glued to a half one.
Status write_all(int fd, const std::string& path, std::string_view lines) {
  struct stat before {};
  if (::fstat(fd, &before) != 0) return results::file_error("write", path, errno);
  while (!lines.empty()) {
    const ssize_t count = ::write(fd, lines.data(), lines.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) {
      const int error = errno;
      [[maybe_unused]] const int rc = ::ftruncate(fd, before.st_size);
      return results::file_error("write", path, error);
    }
    lines.remove_prefix(static_cast<std::size_t>(count));
  }
  if (::fdatasync(fd) != 0 && errno != EINVAL && errno != EROFS)
    return results::file_error("write", path, errno);
  return ok();
}

/// The name of a new file must be on the disk, too.
void keep_name(const std::string& path) {
  const fs::path folder = fs::path(path).parent_path();
  const os::UniqueFd directory(
      ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (directory) ::fsync(directory.get());
}

/// Is it still the file of that name? Another run may have put a compacted one in its place.
bool is_named(int fd, const std::string& path) {
  struct stat own {
  }, named{};
  return ::fstat(fd, &own) == 0 && ::stat(path.c_str(), &named) == 0 &&
         own.st_ino == named.st_ino && own.st_dev == named.st_dev;
}

/// Opened to be appended to, and locked.
Result<os::UniqueFd> open_locked(const std::string& path, int flags) {
  for (;;) {
    os::UniqueFd fd(::open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC | flags, 0666));
    if (!fd || ::flock(fd.get(), LOCK_EX | LOCK_NB) != 0)
      return results::file_error("write", path, errno);
    if (is_named(fd.get(), path)) return fd;
  }
}

}  // namespace

std::string port_of(const std::string& endpoint) {
  const Result<endpoints::EndpointName> name = endpoints::parse_endpoint(endpoint);
  if (!name) return endpoint;
  std::error_code failed;
  const fs::path real = fs::canonical(name->target, failed);
  return name->kind + ":" + (failed ? name->target : real.string());
}

bool is_same_device(const JournalDevice& one, const JournalDevice& other) {
  return one.station == other.station && port_of(one.endpoint) == port_of(other.endpoint);
}

Result<std::vector<OpenEntry>> read_journal(const std::string& path) {
  Result<Contents> contents = read(path);
  if (!contents) return contents.error();
  return std::move(contents->open);
}

Result<Journal> Journal::open(const std::string& path) {
  const fs::path folder = fs::path(path).parent_path();
  std::error_code failed;
  if (!folder.empty()) fs::create_directories(folder, failed);
  Result<os::UniqueFd> fd = open_locked(path, 0);
  if (!fd) return fd.error();
  Result<Contents> contents = read(path);
  if (!contents) return contents.error();
  const auto keep = static_cast<off_t>(contents->open.empty() ? 0 : contents->size);
  if (::ftruncate(fd->get(), keep) != 0) return results::file_error("write", path, errno);
  keep_name(path);
  Journal journal(path, std::move(*fd));
  journal.open_ = std::move(contents->open);
  journal.last_number_ = contents->last_number;
  if (keep > 0) journal.close_lines(contents->lines - journal.open_.size());
  return journal;
}

Status Journal::append(const std::string& lines) { return write_all(fd_.get(), path_, lines); }

/// What cannot be compacted stays as it is, and is tried again when as much more is closed. The new
/// file is whole, on the disk and locked before it has the name.
void Journal::compact() {
  closed_lines_ = 0;
  std::error_code failed;
  const std::string real = fs::canonical(path_, failed).string();
  const std::string beside = real + ".new";
  Result<os::UniqueFd> fd = open_locked(beside, O_TRUNC);
  if (failed || !fd) return;
  std::string lines;
  for (const OpenEntry& one : open_) lines += saved_line(one);
  if (!write_all(fd->get(), beside, lines) || ::rename(beside.c_str(), real.c_str()) != 0) {
    ::unlink(beside.c_str());
    return;
  }
  keep_name(real);
  fd_ = std::move(*fd);
}

Status Journal::save(std::span<OpenEntry> entries) {
  if (entries.empty()) return ok();
  std::string lines;
  for (OpenEntry& entry : entries) {
    entry.number = ++last_number_;
    lines += saved_line(entry);
  }
  if (Status written = append(lines); !written) return written;
  open_.insert(open_.end(), entries.begin(), entries.end());
  return ok();
}

Status Journal::restored(const OpenEntry& entry) {
  std::erase_if(open_, [&entry](const OpenEntry& one) { return one.number == entry.number; });
  const json line{{"restored", {{"number", entry.number}, {"address", entry.address}}}};
  if (Status written = append(line.dump() + '\n'); !written) return written;
  close_lines(2);
  return ok();
}

void Journal::close_lines(std::size_t count) {
  closed_lines_ += count;
  if (closed_lines_ >= most_closed_lines && closed_lines_ >= open_.size()) compact();
}

Status Journal::discard(const JournalDevice& device) {
  const std::vector<OpenEntry> entries = open_;
  for (const OpenEntry& one : entries)
    if (is_same_device(one.device, device))
      if (Status done = restored(one); !done) return done;
  return ok();
}

}  // namespace fieldproof::safety
