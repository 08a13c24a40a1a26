#include "harness/hosting/host_port.hpp"

#include <fcntl.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <filesystem>

#include "harness/endpoints/serial_settings.hpp"
#include "harness/system/pty_pair.hpp"
#include "harness/system/socket_address.hpp"
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

  Result<Bytes> read() override {
    std::array<Byte, 4096> buffer;
    const ssize_t n = ::read(fd_.get(), buffer.data(), buffer.size());
    if (n > 0) return Bytes(buffer.begin(), buffer.begin() + n);
    if (n < 0 && (errno == EAGAIN || errno == EINTR)) return Bytes{};
    return fail("cannot read " + description_ +
                ": the other end is gone; start it again, then this");
  }

  void write(ByteView bytes) override {
    [[maybe_unused]] const ssize_t n = ::write(fd_.get(), bytes.data(), bytes.size());
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

/// The clients of a listening socket, on one line together.
class TcpPort final : public HostPort {
 public:
  TcpPort(UniqueFd listener, std::string description)
      : listener_(std::move(listener)), description_(std::move(description)) {}

  std::string describe() const override { return description_; }
  void add_to(std::vector<pollfd>& fds) const override {
    fds.push_back({listener_.get(), POLLIN, 0});
    for (const UniqueFd& client : clients_) fds.push_back({client.get(), POLLIN, 0});
  }

  Result<Bytes> read() override {
    accept_all();
    for (std::size_t i = 0; i < clients_.size();) {
      std::array<Byte, 4096> buffer;
      const ssize_t n = ::recv(clients_[i].get(), buffer.data(), buffer.size(), 0);
      if (n > 0) {
        heard_ = clients_[i].get();
        return Bytes(buffer.begin(), buffer.begin() + n);
      }
      if (n == 0 || (errno != EAGAIN && errno != EINTR)) {
        forget(i);
      } else {
        ++i;
      }
    }
    return Bytes{};
  }

  void write(ByteView bytes) override {
    for (const UniqueFd& client : clients_) {
      if (heard_ && *heard_ != client.get()) continue;
      [[maybe_unused]] const ssize_t n =
          ::send(client.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL);
    }
  }

  void flush() override {
    for (Result<Bytes> left = read(); left && !left->empty(); left = read()) {
    }
  }

 private:
  void accept_all() {
    for (;;) {
      UniqueFd client(::accept4(listener_.get(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK));
      if (!client) return;
      const int yes = 1;
      ::setsockopt(client.get(), IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
      clients_.push_back(std::move(client));
    }
  }

  void forget(std::size_t i) {
    if (heard_ == clients_[i].get()) heard_.reset();
    clients_.erase(clients_.begin() + static_cast<std::ptrdiff_t>(i));
  }

  UniqueFd listener_;
  std::vector<UniqueFd> clients_;
  std::optional<int> heard_;
  std::string description_;
};

int listen_on(const addrinfo& address, UniqueFd& fd) {
  fd.reset(::socket(address.ai_family, address.ai_socktype | SOCK_CLOEXEC | SOCK_NONBLOCK,
                    address.ai_protocol));
  if (!fd) return errno;
  const int yes = 1;
  ::setsockopt(fd.get(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  return ::bind(fd.get(), address.ai_addr, address.ai_addrlen) == 0 && ::listen(fd.get(), 16) == 0
             ? 0
             : errno;
}

std::string bound_port(int fd) {
  sockaddr_storage address{};
  socklen_t size = sizeof address;
  ::getsockname(fd, reinterpret_cast<sockaddr*>(&address), &size);
  const in_port_t port = address.ss_family == AF_INET6
                             ? reinterpret_cast<const sockaddr_in6&>(address).sin6_port
                             : reinterpret_cast<const sockaddr_in&>(address).sin_port;
  return std::to_string(ntohs(port));
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

Result<std::unique_ptr<HostPort>> open_tcp_port(const std::string& host_and_port) {
  const std::string start = "cannot listen on " + host_and_port + ": ";
  const Result<os::AddressInfo> list = os::resolve(host_and_port, true);
  if (!list) return fail(start + list.error().message);
  UniqueFd fd;
  int error = EADDRNOTAVAIL;
  for (const addrinfo* one = list->get(); one && error != 0; one = one->ai_next)
    error = listen_on(*one, fd);
  if (error != 0) return fail(start + os::errno_text(error) + "; choose another port or address");
  const std::string host = host_and_port.substr(0, host_and_port.rfind(':'));
  const std::string description = "tcp " + host + ':' + bound_port(fd.get());
  return std::unique_ptr<HostPort>(std::make_unique<TcpPort>(std::move(fd), description));
}

}  // namespace fieldproof::hosting
