#include "harness/endpoints/serial.hpp"

#include <fcntl.h>
#include <grp.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <termios.h>

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "harness/endpoints/kinds.hpp"
#include "harness/endpoints/options.hpp"
#include "harness/endpoints/receive_latency.hpp"
#include "harness/endpoints/serial_settings.hpp"
#include "harness/system/fd_link.hpp"
#include "harness/system/port_lock.hpp"
#include "harness/system/port_user.hpp"

namespace fieldproof::endpoints {

namespace {

/// An argument of ioctl that is a number.
void* number(std::intptr_t value) { return reinterpret_cast<void*>(value); }

std::string group_of(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) return "dialout";
  const group* entry = ::getgrgid(status.st_gid);  // start-up, one thread
  return entry && std::string_view(entry->gr_name) != "root" ? entry->gr_name : "dialout";
}

std::string ports_there() {
  std::string list;
  std::error_code none;
  for (const auto& one : std::filesystem::directory_iterator("/dev/serial/by-id", none)) {
    list += (list.empty() ? "" : ", ") + one.path().string();
  }
  return list.empty() ? "plug in the adapter (none is listed in /dev/serial/by-id)"
                      : "these are there: " + list;
}

Error absent(std::string message) {
  Error error = fail(std::move(message));
  error.absent = true;
  return error;
}

Error open_error(const std::string& path, int error) {
  const std::string start = "cannot open " + path + ": ";
  switch (error) {
    case EACCES:
      return fail(start + "permission denied; add yourself to the group " + group_of(path));
    case ENOENT: return absent(start + "there is no such port; " + ports_there());
    case EBUSY:
    case EWOULDBLOCK:
      return fail(start + "the port is in use" + os::port_user(path) +
                  "; end that process or choose another port");
    case ENODEV:
    case ENXIO:
    case EIO:
      return absent(start + "no adapter behind this name; plug it in or choose another port");
    default:
      return fail(start + os::errno_text(error) + "; name a terminal device such as /dev/ttyUSB0");
  }
}

class SerialEndpoint final : public Endpoint {
 public:
  SerialEndpoint(const os::SystemCalls& calls, os::UniqueFd fd, os::PortLock lock,
                 std::unique_ptr<ReceiveLatency> latency, const EndpointName& name,
                 const SerialOptions& options)
      : calls_(calls),
        lock_(std::move(lock)),
        path_(name.target),
        settings_(options.settings),
        direction_(options.direction),
        link_(std::move(fd), "serial:" + path_),
        latency_(std::move(latency)) {
    capabilities_ = capabilities_of(name);
    capabilities_.wire = !is_pty(calls_, link_.fd());
    capabilities_.timing_floor = options.floor;
    if (capabilities_.wire) use_wire();
    counting_ = read_line_errors(calls_, link_.fd(), counted_);
  }
  ~SerialEndpoint() override {
    // Where another process keeps the terminal open, the exclusive mode would outlive us.
    calls_.ioctl(link_.fd(), TIOCNXCL, nullptr);
  }

  const Capabilities& capabilities() const override { return capabilities_; }
  std::string describe() const override {
    return "serial:" + path_ + ' ' + line::to_string(settings_);
  }
  Time now() const override { return link_.now(); }
  Duration character_time() const override { return settings_.character_time(); }
  void has_no_wire() override {
    capabilities_.wire = false;
    capabilities_.driver_silence.reset();
    link_.set_character_time({});
  }
  Status begin(const nlohmann::json&) override { return ok(); }
  Result<Burst> receive(Time deadline) override { return link_.receive(deadline); }

  using Endpoint::send;
  Result<Sent> send(ByteView bytes, LinkId) override {
    if (direction_ != Direction::rts) return link_.send(bytes);
    if (const Status on = set_rts(calls_, link_.fd(), path_, true); !on) return on.error();
    Result<Sent> sent = link_.send(bytes);
    // The time is over by now; TCSBRK with 1 (tcdrain) covers what the driver still holds.
    calls_.ioctl(link_.fd(), TCSBRK, number(1));
    if (const Status off = set_rts(calls_, link_.fd(), path_, false); !off) return off.error();
    return sent;
  }

  std::string line_errors() override {
    LineErrorCounts counts;
    if (!counting_ || !read_line_errors(calls_, link_.fd(), counts)) return "";
    std::string text = line_errors_between(counted_, counts);
    counted_ = counts;
    return text;
  }

 private:
  void use_wire() {
    link_.set_character_time(settings_.character_time());
    capabilities_.line = line::to_string(settings_);
    capabilities_.driver_silence = latency_->silence(settings_.character_time());
    capabilities_.driver_silence_by = latency_->describe();
  }

  os::SystemCalls calls_;
  os::PortLock lock_;  // outlives link_: the port is free when its lock is
  Capabilities capabilities_;
  std::string path_;
  line::LineSettings settings_;
  Direction direction_;
  os::FdLink link_;
  std::unique_ptr<ReceiveLatency> latency_;  // nullptr: a pty
  LineErrorCounts counted_;
  bool counting_ = false;
};

Status make_exclusive(const os::SystemCalls& calls, os::UniqueFd& fd, const std::string& path) {
  if (calls.flock(fd.get(), LOCK_EX | LOCK_NB) != 0) {
    const int error = errno;
    fd.reset();  // so that it is not found as the port's user
    return open_error(path, error);
  }
  calls.ioctl(fd.get(), TIOCEXCL, nullptr);
  // Root opens what another has for itself. Both ends of a pty belong to whoever made it.
  const std::string other = is_pty(calls, fd.get()) ? "" : os::other_port_user(path);
  if (other.empty()) return ok();
  calls.ioctl(fd.get(), TIOCNXCL, nullptr);
  return fail("cannot open " + path + ": the port is in use" + other +
              "; end that process or choose another port");
}

}  // namespace

Result<std::unique_ptr<Endpoint>> open_serial(const EndpointName& name) {
  return open_serial(name, os::real_system_calls());
}

Result<std::unique_ptr<Endpoint>> open_serial(const EndpointName& name,
                                              const os::SystemCalls& calls) {
  const std::string& path = name.target;
  const Result<SerialOptions> options = serial_options(name);
  if (!options) return options.error();
  if (path.empty())
    return fail("cannot open serial: there is no port; write serial:/dev/ttyUSB0; " +
                ports_there());

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
  if (const Status done = apply_settings(calls, fd.get(), path, options->settings); !done)
    return done.error();
  if (const Status done = apply_direction(calls, fd.get(), path, options->direction); !done)
    return done.error();
  calls.ioctl(fd.get(), TCFLSH, number(TCIOFLUSH));
  return std::unique_ptr<Endpoint>(std::make_unique<SerialEndpoint>(
      calls, std::move(fd), std::move(*lock), std::move(latency), name, *options));
}

}  // namespace fieldproof::endpoints
