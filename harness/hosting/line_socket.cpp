#include <sys/socket.h>

#include <array>
#include <cerrno>

#include "harness/hosting/host_port.hpp"
#include "harness/hosting/listening.hpp"
#include "harness/system/sockets/socket_listen.hpp"

namespace fieldproof::hosting {

namespace {

class LineSocket final : public HostPort {
 public:
  LineSocket(os::UniqueFd listener, std::string description)
      : listener_(std::move(listener)), description_(std::move(description)) {}

  std::string describe() const override { return description_; }
  void add_to(std::vector<pollfd>& fds) const override {
    fds.push_back({listener_.get(), POLLIN, 0});
    for (const os::UniqueFd& client : clients_) fds.push_back({client.get(), POLLIN, 0});
  }

  Result<std::optional<Burst>> read() override {
    os::SocketAddress from;
    while (os::UniqueFd client = os::accept_socket(listener_.get(), from))
      clients_.push_back(std::move(client));
    for (std::size_t i = 0; i < clients_.size();) {
      std::array<Byte, 4096> buffer;
      const ssize_t n = ::recv(clients_[i].get(), buffer.data(), buffer.size(), 0);
      if (n > 0) {
        heard_ = clients_[i].get();
        return std::optional(Burst{.bytes = Bytes(buffer.begin(), buffer.begin() + n)});
      }
      if (n == 0 || (errno != EAGAIN && errno != EINTR)) {
        forget(i);
      } else {
        ++i;
      }
    }
    return std::optional<Burst>();
  }

  void write(const Burst& burst) override {
    for (const os::UniqueFd& client : clients_) {
      if (heard_ && *heard_ != client.get()) continue;
      [[maybe_unused]] const ssize_t n =
          ::send(client.get(), burst.bytes.data(), burst.bytes.size(), MSG_NOSIGNAL);
    }
  }

  void flush() override {
    for (Result<std::optional<Burst>> left = read(); left && *left; left = read()) {
    }
  }

 private:
  void forget(std::size_t i) {
    if (heard_ == clients_[i].get()) heard_.reset();
    clients_.erase(clients_.begin() + static_cast<std::ptrdiff_t>(i));
  }

  os::UniqueFd listener_;
  std::vector<os::UniqueFd> clients_;
  std::optional<int> heard_;
  std::string description_;
};

}  // namespace

Result<std::unique_ptr<HostPort>> open_line_socket(const std::string& host_and_port) {
  Result<Listening> listening = listen_on(host_and_port, Transport::tcp, std::nullopt);
  if (!listening) return listening.error();
  return std::unique_ptr<HostPort>(std::make_unique<LineSocket>(
      std::move(listening->socket), "tcp " + to_string(listening->name)));
}

}  // namespace fieldproof::hosting
