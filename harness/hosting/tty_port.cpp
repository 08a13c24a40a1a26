#include "harness/hosting/host_port.hpp"

#include <fcntl.h>
#include <sys/ioctl.h>

#include <array>
#include <cerrno>
#include <filesystem>

#include "harness/endpoints/serial_ports/serial_port.hpp"
#include "harness/endpoints/serial_ports/serial_settings.hpp"
#include "harness/system/pty_pair.hpp"
#include "harness/system/system_calls.hpp"
#include "src/line/settings.hpp"

namespace fieldproof::hosting {

using os::UniqueFd;

namespace {

namespace fs = std::filesystem;

/// A terminal: the slave of somebody's pty, the master of our own, or what RealPort adds to.
class TtyPort final : public HostPort {
 public:
  TtyPort(UniqueFd fd, UniqueFd slave, std::string description, fs::path link)
      : fd_(std::move(fd)),
        slave_(std::move(slave)),
        description_(std::move(description)),
        link_(std::move(link)) {}
  ~TtyPort() override {
    std::error_code none;
    if (!link_.empty()) fs::remove(link_, none);
  }

  std::string describe() const override { return description_; }
  void add_to(std::vector<pollfd>& fds) const override { fds.push_back({fd_.get(), POLLIN, 0}); }

  Result<std::optional<Burst>> read() override {
    std::array<Byte, 4096> buffer;
    const ssize_t n = ::read(fd_.get(), buffer.data(), buffer.size());
    if (n > 0) return std::optional(Burst{.bytes = Bytes(buffer.begin(), buffer.begin() + n)});
    if (n < 0 && (errno == EAGAIN || errno == EINTR)) return std::optional<Burst>();
    return fail("cannot read " + description_ +
                ": the other end is gone; start it again, then this");
  }

  void write(const Burst& burst) override {
    [[maybe_unused]] const ssize_t n = ::write(fd_.get(), burst.bytes.data(), burst.bytes.size());
  }
  void flush() override { os::drop_waiting_bytes(fd_.get()); }
  int fd() const { return fd_.get(); }

 private:
  UniqueFd fd_;
  UniqueFd slave_;  // of our own pty: kept open, so that a client's close does not end the line
  std::string description_;
  fs::path link_;
};

/// A port with a UART behind it, for this process alone.
class RealPort final : public HostPort {
 public:
  RealPort(endpoints::SerialPort port, const std::string& path, line::LineSettings settings)
      : lock_(std::move(port.lock)),
        path_(path),
        settings_(settings),
        port_(std::move(port.fd), UniqueFd(), path, fs::path()),
        latency_(std::move(port.latency)) {}
  ~RealPort() override { os::real_system_calls().ioctl(port_.fd(), TIOCNXCL, nullptr); }

  std::string describe() const override {
    const std::string driver = latency_->describe();
    return path_ + ' ' + line::to_string(settings_) + (driver.empty() ? "" : " (" + driver + ')');
  }
  Duration own_silence() const override {
    return latency_->pause(settings_.character_time()).value_or(HostPort::own_silence());
  }
  void add_to(std::vector<pollfd>& fds) const override { port_.add_to(fds); }
  Result<std::optional<Burst>> read() override { return port_.read(); }
  void write(const Burst& burst) override { port_.write(burst); }
  void flush() override { port_.flush(); }

 private:
  os::PortLock lock_;  // outlives port_: the port is free when its lock is
  std::string path_;
  line::LineSettings settings_;
  TtyPort port_;
  std::unique_ptr<endpoints::ReceiveLatency> latency_;
};

Result<std::unique_ptr<HostPort>> use_pty(UniqueFd fd, const std::string& path) {
  if (!os::set_raw(fd.get())) return fail("cannot use " + path + ": " + os::errno_text(errno));
  return std::unique_ptr<HostPort>(
      std::make_unique<TtyPort>(std::move(fd), UniqueFd(), path, fs::path()));
}

Result<std::unique_ptr<HostPort>> open_real_port(const std::string& path, const std::string& line) {
  const Result<line::LineSettings> settings = line::parse_line_settings(line);
  if (!settings) return settings.error();
  Result<endpoints::SerialPort> port =
      endpoints::open_serial_port(os::real_system_calls(), path, *settings);
  if (!port) return port.error();
  return std::unique_ptr<HostPort>(std::make_unique<RealPort>(std::move(*port), path, *settings));
}

constexpr std::string_view advice = "; choose a terminal, or a path where there is nothing yet";

/// Nothing: there is nothing at this path.
Result<std::optional<UniqueFd>> open_terminal(const std::string& path) {
  UniqueFd fd(::open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  if (!fd && errno == ENOENT) return std::optional<UniqueFd>();
  if (!fd) return fail("cannot open " + path + ": " + os::errno_text(errno).append(advice));
  if (!::isatty(fd.get()))
    return fail("cannot use " + path + ": it is no terminal" + std::string(advice));
  return std::optional(std::move(fd));
}

Result<std::unique_ptr<HostPort>> make_pty(const std::string& path) {
  Result<os::PtyPair> pty = os::open_pty_pair();
  if (!pty) return pty.error();
  std::string description = "pty " + pty->path;
  if (!path.empty()) {
    std::error_code error;
    fs::remove(path, error);  // a link to nothing, left by one that was killed
    fs::create_symlink(pty->path, path, error);
    if (error) {
      return fail("cannot make the link " + path + ": " + os::errno_text(error.value()) +
                  "; choose a path in a folder that you may write");
    }
    description += ", linked from " + path;
  }
  return std::unique_ptr<HostPort>(std::make_unique<TtyPort>(
      std::move(pty->master), std::move(pty->slave), description, fs::path(path)));
}

}  // namespace

Result<std::unique_ptr<HostPort>> open_pty_port(const std::string& path) {
  if (path.empty()) return make_pty(path);
  Result<std::optional<UniqueFd>> fd = open_terminal(path);
  if (!fd) return fd.error();
  if (!*fd) return make_pty(path);
  if (!endpoints::is_pty(os::real_system_calls(), (*fd)->get()))
    return fail("cannot use " + path + " as a pty: it is a real port; write --tty " + path);
  return use_pty(std::move(**fd), path);
}

Result<std::unique_ptr<HostPort>> open_tty_port(const std::string& path, const std::string& line) {
  const UniqueFd name(::open(path.c_str(), O_PATH | O_CLOEXEC));  // touches no line
  if (name && !endpoints::is_pty(os::real_system_calls(), name.get()))
    return open_real_port(path, line);
  Result<std::optional<UniqueFd>> fd = open_terminal(path);
  if (!fd) return fd.error();
  if (!*fd)
    return fail("cannot open " + path +
                ": there is no such port; write --pty for a new pty, linked from there");
  return use_pty(std::move(**fd), path);
}

}  // namespace fieldproof::hosting
