#include "harness/safety/journal.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>
#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <fstream>

#include "harness/endpoints/endpoint.hpp"
#include "reports/results/file_error.hpp"

namespace fieldproof::safety {

namespace {

using nlohmann::json;
namespace fs = std::filesystem;

/// Kind and target, links followed.
std::string port_of(const std::string& endpoint) {
  const Result<endpoints::EndpointName> name = endpoints::parse_endpoint(endpoint);
  if (!name) return endpoint;
  std::error_code failed;
  const fs::path real = fs::canonical(name->target, failed);
  return name->kind + ":" + (failed ? name->target : real.string());
}

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

struct Contents {
  std::vector<OpenEntry> open;
  std::uint64_t last_number = 0;
  std::uintmax_t size = 0;  // of the complete lines
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
      take(json::parse(text), contents);
    } catch (const json::exception& error) {
      return fail(
          fmt::format("cannot read journal {}, line {}: {}; repair the line, it may be all that is "
                      "known of a device's values",
                      path, number, error.what()));
    }
    contents.size += text.size() + 1;
  }
  return contents;
}

}  // namespace

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
  os::UniqueFd fd(::open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666));
  if (!fd) return results::file_error("write", path, errno);
  if (::flock(fd.get(), LOCK_EX | LOCK_NB) != 0) return results::file_error("write", path, errno);
  Result<Contents> contents = read(path);
  if (!contents) return contents.error();
  const auto keep = static_cast<off_t>(contents->open.empty() ? 0 : contents->size);
  if (::ftruncate(fd.get(), keep) != 0) return results::file_error("write", path, errno);
  // The name of a new file must be on the disk, too.
  const os::UniqueFd directory(
      ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (directory) ::fsync(directory.get());
  Journal journal(path, std::move(fd));
  journal.open_ = std::move(contents->open);
  journal.last_number_ = contents->last_number;
  return journal;
}

Status Journal::append(const std::string& lines) {
  for (std::size_t done = 0; done < lines.size();) {
    const ssize_t count = ::write(fd_.get(), lines.data() + done, lines.size() - done);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return results::file_error("write", path_, errno);
    done += static_cast<std::size_t>(count);
  }
  if (::fdatasync(fd_.get()) != 0 && errno != EINVAL && errno != EROFS)
    return results::file_error("write", path_, errno);
  return ok();
}

Status Journal::save(std::span<OpenEntry> entries) {
  if (entries.empty()) return ok();
  std::string lines;
  for (OpenEntry& entry : entries) {
    entry.number = ++last_number_;
    lines += json{{"saved", to_json(entry)}}.dump() + '\n';
  }
  if (Status written = append(lines); !written) return written;
  open_.insert(open_.end(), entries.begin(), entries.end());
  return ok();
}

Status Journal::restored(const OpenEntry& entry) {
  std::erase_if(open_, [&entry](const OpenEntry& one) { return one.number == entry.number; });
  return append(json{{"restored", {{"number", entry.number}, {"address", entry.address}}}}.dump() +
                '\n');
}

Status Journal::discard(const JournalDevice& device) {
  const std::vector<OpenEntry> entries = open_;
  for (const OpenEntry& one : entries)
    if (is_same_device(one.device, device))
      if (Status done = restored(one); !done) return done;
  return ok();
}

}  // namespace fieldproof::safety
