#include "harness/system/port_user.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <system_error>
#include <vector>

namespace fieldproof::os {

namespace {

namespace fs = std::filesystem;

/// The process that holds the lock: "1: FLOCK  ADVISORY  WRITE 1234 00:18:7 0 EOF", the inode last.
std::string lock_holder(const struct stat& port) {
  std::ifstream locks("/proc/locks");
  for (std::string line; std::getline(locks, line);) {
    std::istringstream words(line);
    std::string number, kind, advisory, mode, process, file;
    words >> number >> kind >> advisory >> mode >> process >> file;
    if (kind == "FLOCK" && file.substr(file.rfind(':') + 1) == std::to_string(port.st_ino))
      return process;
  }
  return "";
}

bool has_open(const fs::path& process, const struct stat& port) {
  std::error_code none;
  // Not a range-for, which throws when the process ends meanwhile.
  for (fs::directory_iterator one(process / "fd", none), end; one != end; one.increment(none)) {
    struct stat status {};
    if (::stat(one->path().c_str(), &status) == 0 && status.st_dev == port.st_dev &&
        status.st_ino == port.st_ino)
      return true;
  }
  return false;
}

std::string opener(const struct stat& port, const std::string& but = "") {
  std::error_code none;
  for (fs::directory_iterator one("/proc", none), end; one != end; one.increment(none)) {
    const std::string name = one->path().filename();
    if (name.find_first_not_of("0123456789") == std::string::npos && name != but &&
        has_open(one->path(), port))
      return name;
  }
  return "";
}

}  // namespace

std::string port_user(const std::string& path) {
  struct stat port {};
  if (::stat(path.c_str(), &port) != 0) return "";
  std::string process = lock_holder(port);
  if (process.empty()) process = opener(port);
  return process.empty() ? "" : " by " + process_name(process);
}

std::string other_port_user(const std::string& path) {
  struct stat port {};
  if (::stat(path.c_str(), &port) != 0) return "";
  const std::string process = opener(port, std::to_string(::getpid()));
  return process.empty() ? "" : " by " + process_name(process);
}

std::string process_name(const std::string& process) {
  std::string name;
  std::ifstream comm("/proc/" + process + "/comm");
  std::getline(comm, name);
  return "process " + process + (name.empty() ? "" : " (" + name + ')');
}

}  // namespace fieldproof::os
