#include <fmt/format.h>

#include "harness/hosting/host_port.hpp"
#include "harness/hosting/listening.hpp"
#include "harness/system/sockets/socket_connect.hpp"
#include "harness/system/sockets/socket_links.hpp"

namespace fieldproof::hosting {

namespace {

class NetworkPort final : public HostPort {
 public:
  explicit NetworkPort(const NetworkPortOptions& options) : options_(options) {}

  Status listen(const std::string& address, Transport transport) {
    if (address.empty()) return ok();
    const std::uint16_t port = transport == Transport::tcp ? options_.port : options_.udp_port;
    Result<Listening> listening = listen_on(address, transport, port);
    if (!listening) return listening.error();
    links_.listen(std::move(listening->socket), transport, port);
    description_ +=
        fmt::format("{}{} {}", description_.empty() ? "" : ", ",
                    transport == Transport::tcp ? "tcp" : "udp", to_string(listening->name));
    return ok();
  }

  std::string describe() const override {
    return description_.empty() ? "a network, where it connects to others" : description_;
  }
  void add_to(std::vector<pollfd>& fds) const override { links_.add_to(fds); }

  void heard(std::span<const pollfd> answers) override { links_.heard(answers); }

  Result<std::optional<Burst>> read() override {
    links_.flush();
    return links_.take();
  }

  void write(const Burst& burst) override {
    switch (burst.event) {
      case LinkEvent::opened: return connect(burst, Transport::tcp);
      case LinkEvent::closed: return drop(links_.close(burst.link, Closing::fin));
      case LinkEvent::reset: return drop(links_.close(burst.link, Closing::rst));
      case LinkEvent::datagram:
        if (burst.port != 0 && burst.link >= first_own_link) connect(burst, Transport::udp);
        break;
      case LinkEvent::data: break;
    }
    drop(links_.send(burst.link, burst.bytes));
  }

  bool stands(LinkId link) const override { return links_.stands(link); }
  void flush() override { links_.end_all(); }

 private:
  /// What is done on a link that has ended meanwhile is lost.
  static void drop(const Status&) {}

  /// A link of the device's own.
  void connect(const Burst& burst, Transport transport) {
    if (transport == Transport::udp && links_.has(burst.link)) return;
    os::UniqueFd fd = os::begin_connecting({burst.peer, burst.port},
                                           transport == Transport::tcp ? SOCK_STREAM : SOCK_DGRAM);
    if (transport == Transport::tcp)
      links_.add(burst.link, os::Connection(std::move(fd)));
    else
      links_.add(burst.link, os::DatagramPort(std::move(fd)));
  }

  NetworkPortOptions options_;
  os::SocketLinks links_{line_link + 1};
  std::string description_;
};

}  // namespace

Result<std::unique_ptr<HostPort>> open_network_port(const NetworkPortOptions& options) {
  auto port = std::make_unique<NetworkPort>(options);
  if (const Status tcp = port->listen(options.tcp, Transport::tcp); !tcp) return tcp.error();
  if (const Status udp = port->listen(options.udp, Transport::udp); !udp) return udp.error();
  return std::unique_ptr<HostPort>(std::move(port));
}

}  // namespace fieldproof::hosting
