#include "harness/endpoints/serial_ports/serial_port.hpp"

#include <fcntl.h>
#include <grp.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstdio>
#include <filesystem>

#include "harness/endpoints/serial_ports/serial_settings.hpp"
#include "harness/system/port_user.hpp"

namespace fieldproof::endpoints {

namespace {

std::string group_of(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) return "dialout";
  const group* entry = ::getgrgid(status.st_gid);  // start-up, one thread
  return entry && std::string_view(entry->gr_name) != "root" ? entry->gr_name : "dialout";
}

Error absent(std::string message) {
  Error error = fail(std::move(message));
  error.absent = true;
  return error;
}

Error in_use(const std::string& path, const std::string& user) {
  return fail("cannot open " + path + ": the port is in use" + user +
              "; end that process or choose another port");
}

Error open_error(const std::string& path, int error) {
  const std::string start = "cannot open " + path + ": ";
  switch (error) {
    case EACCES:
      return fail(start + "permission denied; add yourself to the group " + group_of(path));
    case ENOENT: return absent(start + "there is no such port; " + serial_ports_there());
    case EBUSY:
    case EWOULDBLOCK: return in_use(path, os::port_user(path));
    case ENODEV:
    case ENXIO:
    case EIO:
      return absent(start + "no adapter behind this name; plug it in or choose another port");
    default:
      return fail(start + os::errno_text(error) + "; name a terminal device such as /dev/ttyUSB0");
  }
}

Status make_exclusive(const os::SystemCalls& calls, os::UniqueFd& fd, const std::string& path) {
  if (calls.flock(fd.get(), LOCK_EX | LOCK_NB) != 0) {
    const int error = errno;
    fd.reset();  // so that it is not found as the port's user
    return open_error(path, error);
  }
  // Root opens what another has for itself. Both ends of a pty belong to whoever made it.
  const std::string other = is_pty(calls, fd.get()) ? "" : os::other_port_user(path);
  if (!other.empty()) return in_use(path, other);
  calls.ioctl(fd.get(), TIOCEXCL, nullptr);
  return ok();
}

}  // namespace

std::string serial_ports_there() {
  std::string list;
  std::error_code none;
  for (const auto& one : std::filesystem::directory_iterator("/dev/serial/by-id", none)) {
    list += (list.empty() ? "" : ", ") + one.path().string();
  }
  return list.empty() ? "plug in the adapter (none is listed in /dev/serial/by-id)"
                      : "these are there: " + list;
}

Result<SerialPort> open_serial_port(const os::SystemCalls& calls, const std::string& path,
                                    const line::LineSettings& settings) {
  Result<os::PortLock> lock = os::PortLock::acquire(path);
  if (!lock) return lock.error();
  if (!lock->notice().empty()) std::fprintf(stderr, "fieldproof: %s\n", lock->notice().c_str());
  // O_NONBLOCK: a port without carrier must not block.
  os::UniqueFd fd(calls.open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  if (!fd) return open_error(path, errno);
  if (const Status done = make_exclusive(calls, fd, path); !done) return done.error();
  // Before the speed is set: at a low one the kernel changes the trigger level, and leaves it so.
  std::unique_ptr<ReceiveLatency> latency;
  if (!is_pty(calls, fd.get())) latency = std::make_unique<ReceiveLatency>(calls, fd.get(), path);
  if (const Status done = apply_settings(calls, fd.get(), path, settings); !done)
    return done.error();
  return SerialPort{std::move(*lock), std::move(fd), std::move(latency)};
}

}  // namespace fieldproof::endpoints
