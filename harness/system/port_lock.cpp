#include "harness/system/port_lock.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <limits.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <time.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <optional>
#include <sstream>

#include "harness/system/port_user.hpp"
#include "harness/system/system_calls.hpp"

namespace fieldproof::os {

namespace {

constexpr std::string_view our_mark = "fieldproof";
constexpr int most_attempts =
    8;  // each one lost to another process that took or left the lock meanwhile

/// "LCK..ttyUSB0", "LCK..serial_by-id_usb-FTDI": the name below /dev.
std::string lock_name(std::string port) {
  constexpr std::string_view devices = "/dev/";
  if (port.starts_with(devices)) port.erase(0, devices.size());
  std::ranges::replace(port, '/', '_');
  return "LCK.." + port;
}

/// By the port's own name, the name that it was given, and the numbers of the device. Empty: there
/// is no such port.
std::vector<std::string> lock_names(const std::string& port) {
  struct stat status {};
  std::array<char, PATH_MAX> real{};
  if (!::realpath(port.c_str(), real.data()) || ::stat(real.data(), &status) != 0) return {};
  std::vector<std::string> names{lock_name(real.data())};
  if (lock_name(port) != names.front()) names.push_back(lock_name(port));
  if (S_ISCHR(status.st_mode))
    names.push_back(fmt::format("LCK.{:03}.{:03}", gnu_dev_major(status.st_rdev),
                                gnu_dev_minor(status.st_rdev)));
  return names;
}

/// What a lock file says of its owner.
struct Owner {
  long process = 0;  // 0: the file does not tell
  std::string since;
  bool ours = false;

  bool alive() const {
    return process > 0 && (::kill(static_cast<pid_t>(process), 0) == 0 || errno == EPERM);
  }
};

/// "      1234" and, where the program adds it, its name.
Owner read_owner(int file, const struct stat& status) {
  std::array<char, 64> text{};
  const ssize_t size = ::pread(file, text.data(), text.size(), 0);
  std::istringstream words(
      std::string(text.data(), static_cast<std::size_t>(std::max<ssize_t>(0, size))));
  Owner owner;
  std::string program;
  if (!(words >> owner.process)) owner.process = 0;
  words >> program;
  owner.ours = program == our_mark;
  tm local{};
  ::localtime_r(&status.st_mtime, &local);
  std::array<char, 32> since{};
  owner.since =
      std::string(since.data(), ::strftime(since.data(), since.size(), "%Y-%m-%d %H:%M", &local));
  return owner;
}

Error in_use(const std::string& port, const std::string& lock, const Owner& owner) {
  const std::string who =
      owner.process > 0 ? " by " + process_name(std::to_string(owner.process)) : "";
  return fail(
      fmt::format("cannot open {}: the port is in use{} since {}; end that process or choose "
                  "another port (if it does not use "
                  "the port, delete {})",
                  port, who, owner.since, lock));
}

/// A locked file with our process id, which appears under its name at once and complete.
std::optional<UniqueFd> make_file(const std::string& folder, std::string& temporary) {
  temporary = folder + "/LTMP.XXXXXX";
  UniqueFd fd(::mkostemp(temporary.data(), O_CLOEXEC));
  if (!fd) return std::nullopt;
  const std::string text = fmt::format("{:>10} {}\n", ::getpid(), our_mark);
  const bool written =
      ::write(fd.get(), text.data(), text.size()) == static_cast<ssize_t>(text.size());
  if (written && ::fchmod(fd.get(), 0644) == 0 && ::flock(fd.get(), LOCK_EX | LOCK_NB) == 0)
    return fd;
  ::unlink(temporary.c_str());
  return std::nullopt;
}

/// Removes a lock file whose owner is gone; what to tell the user. Empty: it was gone already.
/// Errors: it has an owner.
Result<std::string> remove_stale(const std::string& port, const std::string& lock) {
  const UniqueFd file(::open(lock.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW));
  if (!file && errno == ENOENT) return std::string();
  struct stat status {};
  if (!file || ::fstat(file.get(), &status) != 0) {
    return fail(fmt::format("cannot open {}: its lock file {} cannot be read ({}); see whose it is",
                            port, lock, errno_text(errno)));
  }
  const Owner owner = read_owner(file.get(), status);
  if (::flock(file.get(), LOCK_EX | LOCK_NB) != 0) return in_use(port, lock, owner);
  if (::fstat(file.get(), &status) == 0 && status.st_nlink == 0) return std::string();
  if (!owner.ours && (owner.process == 0 || owner.alive())) return in_use(port, lock, owner);
  if (::unlink(lock.c_str()) != 0 && errno != ENOENT) {
    return fail(
        fmt::format("cannot open {}: its lock is left over from process {} of {}, and {} cannot be "
                    "removed ({}); have its owner "
                    "delete it",
                    port, owner.process, owner.since, lock, errno_text(errno)));
  }
  return fmt::format("took over the lock of {}: process {}, which locked it on {}, has ended", port,
                     owner.process, owner.since);
}

}  // namespace

std::vector<std::string> lock_folders() {
  std::vector<std::string> folders{"/var/lock"};
  if (const char* own = ::getenv("XDG_RUNTIME_DIR"); own && *own) folders.push_back(own);
  return folders;
}

Result<PortLock> PortLock::acquire(const std::string& port,
                                   const std::vector<std::string>& folders) {
  PortLock lock;
  const std::vector<std::string> names = lock_names(port);
  if (names.empty()) return lock;  // opening it will say why
  for (const std::string& folder : folders) {
    std::string temporary;
    std::optional<UniqueFd> file = make_file(folder, temporary);
    if (!file) continue;
    lock.fd_ = std::move(*file);
    const Status taken = lock.take(port, folder, temporary, names);
    ::unlink(temporary.c_str());
    if (!taken) return taken.error();
    return lock;
  }
  return lock;
}

/// Gives the file its names.
Status PortLock::take(const std::string& port, const std::string& folder,
                      const std::string& temporary, const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    const std::string path = folder + '/' + name;
    for (int i = 0; ::link(temporary.c_str(), path.c_str()) != 0; ++i) {
      if (errno != EEXIST || i == most_attempts)
        return fail(
            fmt::format("cannot lock {}: cannot make {}: {}", port, path, errno_text(errno)));
      const Result<std::string> removed = remove_stale(port, path);
      if (!removed) return removed.error();
      if (!removed->empty()) notice_ = *removed;
    }
    paths_.push_back(path);
  }
  return ok();
}

PortLock::~PortLock() {
  struct stat own {
  }, there{};
  if (!fd_ || ::fstat(fd_.get(), &own) != 0) return;
  for (const std::string& path : paths_) {
    // Somebody may have deleted our file and made another.
    if (::lstat(path.c_str(), &there) == 0 && own.st_dev == there.st_dev &&
        own.st_ino == there.st_ino)
      ::unlink(path.c_str());
  }
}

}  // namespace fieldproof::os
