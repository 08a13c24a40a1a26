#include "harness/hosting/host_port.hpp"

#include <fcntl.h>

#include <array>
#include <cerrno>
#include <filesystem>

#include "harness/endpoints/serial_settings.hpp"
#include "harness/system/pty_pair.hpp"
#include "harness/system/system_calls.hpp"
#include "src/line/settings.hpp"

namespace fieldproof::hosting {

using os::UniqueFd;

namespace {

namespace fs = std::filesystem;

/// A terminal: the slave of somebody's pty, a real port, or the master of our own pty.
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

 private:
  UniqueFd fd_;
  UniqueFd slave_;  // of our own pty: kept open, so that a client's close does not end the line
  std::string description_;
  fs::path link_;
};

Result<std::unique_ptr<HostPort>> use_terminal(UniqueFd fd, const std::string& path,
                                               const std::string& line) {
  if (endpoints::is_pty(os::real_system_calls(), fd.get())) {
    if (!os::set_raw(fd.get())) return fail("cannot use " + path + ": " + os::errno_text(errno));
  } else {
    const Result<line::LineSettings> settings = line::parse_line_settings(line);
    if (!settings) return settings.error();
    if (const Status done =
            endpoints::apply_settings(os::real_system_calls(), fd.get(), path, *settings);
        !done)
      return done.error();
  }
  return std::unique_ptr<HostPort>(
      std::make_unique<TtyPort>(std::move(fd), UniqueFd(), path, fs::path()));
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

Result<std::unique_ptr<HostPort>> open_tty_port(const std::string& path, const std::string& line) {
  if (path.empty()) return make_pty(path);
  UniqueFd fd(::open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  if (!fd && errno == ENOENT) return make_pty(path);
  constexpr std::string_view advice = "; choose a terminal, or a path where there is nothing yet";
  if (!fd) return fail("cannot open " + path + ": " + os::errno_text(errno).append(advice));
  if (!::isatty(fd.get()))
    return fail("cannot use " + path + ": it is no terminal" + std::string(advice));
  return use_terminal(std::move(fd), path, line);
}

}  // namespace fieldproof::hosting
