// Where a hosted device hears and speaks: a terminal, the clients of a socket on one line, or the
// connections and datagrams of a network.
#pragma once

#include <poll.h>

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "src/base/burst.hpp"
#include "src/base/result.hpp"

namespace fieldproof::hosting {

/// Bursts are those of a device: on a line `data` on line_link, on a network as net::Host has them.
/// Their `start` is left to the host.
class HostPort {
 public:
  virtual ~HostPort() = default;

  /// "pty /dev/pts/4, linked from /tmp/plc", "tcp 127.0.0.1:2004".
  virtual std::string describe() const = 0;
  /// Silence that the link makes itself between bytes that came without a pause.
  virtual Duration own_silence() const { return 20ms; }
  /// What to wait for.
  virtual void add_to(std::vector<pollfd>& fds) const = 0;
  /// What came of it; `answers` begin with those of `add_to`.
  virtual void heard(std::span<const pollfd> answers) { (void)answers; }
  /// What came next, of one speaker; nothing: nothing is there. An error ends the host.
  virtual Result<std::optional<Burst>> read() = 0;
  /// What the device does. What nobody takes is lost, as on a line to which nobody listens.
  virtual void write(const Burst& burst) = 0;
  /// Does a connection of the device's own stand? Else what it sends there waits, or is lost.
  virtual bool stands([[maybe_unused]] LinkId link) const { return true; }
  /// A fresh device begins: drops what waits in either direction, and all links.
  virtual void flush() = 0;
};

/// A pty of our own, linked from `path` where that is not empty; or what is there: the slave of
/// somebody's pty.
Result<std::unique_ptr<HostPort>> open_pty_port(const std::string& path);
/// A terminal that is there: somebody's pty, or a real port, which is locked, set to `line`
/// ("9600-8N1") and told to hand over at once.
Result<std::unique_ptr<HostPort>> open_tty_port(const std::string& path, const std::string& line);
/// The clients of a listening socket, on one line together. HOST:PORT; without HOST: loopback.
Result<std::unique_ptr<HostPort>> open_line_socket(const std::string& host_and_port);

struct NetworkPortOptions {
  std::string tcp, udp;    // HOST:PORT each; empty: not over this transport; without HOST: loopback
  std::uint16_t port = 0;  // of the device: what comes there comes to this one, and it stands for
                           // the PORT that is left out
  std::uint16_t udp_port = 0;  // the same for datagrams
};
/// Each connection and each peer of datagrams is a link.
Result<std::unique_ptr<HostPort>> open_network_port(const NetworkPortOptions& options);
/// A network, and a line beside it.
std::unique_ptr<HostPort> join_ports(std::unique_ptr<HostPort> network,
                                     std::unique_ptr<HostPort> line);

}  // namespace fieldproof::hosting
