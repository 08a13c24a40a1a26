// The journal of what a real device held before a run wrote there, so that a run that was killed
// can be undone (`fieldproof restore`). One JSON object a line, on the disk before the write goes
// out:
//   {"saved":{"number":7,"endpoint":"serial:/dev/ttyUSB0?station=1","station":1,
//             "protocol":"xgt-cnet","model":"xbc-h","config":{},"address":"%MW100","value":"00E2"}}
//   {"restored":{"number":7,"address":"%MW100"}}    it holds that value again, as was read back
// A last line that is cut short is none: what it announced has not been written to the device.
// Where many entries are closed, the open ones alone are written to a file beside it (path +
// ".new"), which then takes its place: a program that is killed there leaves the one or the other.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "harness/system/unique_fd.hpp"
#include "src/base/result.hpp"

namespace fieldproof::safety {

/// How a device is reached: what `restore` needs to open it again.
struct JournalDevice {
  std::string endpoint;  // as --endpoint takes it
  int station = 1;
  std::string protocol, model;
  nlohmann::json config = nlohmann::json::object();  // declared: where the addresses lie

  bool operator==(const JournalDevice&) const = default;
};

/// Kind and target of an endpoint, links followed.
std::string port_of(const std::string& endpoint);

/// The same endpoint, whatever its options, and station?
bool is_same_device(const JournalDevice& one, const JournalDevice& other);

/// A value that has not been put back.
struct OpenEntry {
  std::uint64_t number = 0;
  JournalDevice device;
  std::string address, value;  // hex digits
};

/// What is open, in the order in which it was saved. No file: nothing. Errors name file and line.
Result<std::vector<OpenEntry>> read_journal(const std::string& path);

class Journal {
 public:
  /// Makes the file, or goes on with it; it is locked as long as this object lives. A file with
  /// nothing open begins anew. It stays within a megabyte and what is open, however much is saved
  /// and restored.
  static Result<Journal> open(const std::string& path);

  /// On the disk when this returns. The entries get their numbers.
  Status save(std::span<OpenEntry> entries);
  Status restored(const OpenEntry& entry);
  /// Forgets what is open of a device (--discard-journal).
  Status discard(const JournalDevice& device);

  const std::vector<OpenEntry>& open_entries() const { return open_; }
  const std::string& path() const { return path_; }

 private:
  Journal(std::string path, os::UniqueFd fd) : path_(std::move(path)), fd_(std::move(fd)) {}
  Status append(const std::string& lines);
  void close_lines(std::size_t count);
  void compact();

  std::string path_;
  os::UniqueFd fd_;
  std::vector<OpenEntry> open_;
  std::uint64_t last_number_ = 0;
  std::size_t closed_lines_ = 0;  // that a file of the open entries would not have
};

}  // namespace fieldproof::safety
