// Where a hosted device hears and speaks: a terminal, or the clients of a listening socket.
#pragma once

#include <poll.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "src/base/bytes.hpp"
#include "src/base/result.hpp"

namespace fieldproof::hosting {

class HostPort {
 public:
  virtual ~HostPort() = default;

  /// "pty /dev/pts/4, linked from /tmp/plc", "tcp 127.0.0.1:2004".
  virtual std::string describe() const = 0;
  /// What to wait for.
  virtual void add_to(std::vector<pollfd>& fds) const = 0;
  /// The bytes that are there, of one speaker; empty: none. An error ends the host.
  virtual Result<Bytes> read() = 0;
  /// Sends what the line takes; the rest is lost, as on a line to which nobody listens.
  virtual void write(ByteView bytes) = 0;
  /// Drops what waits in either direction.
  virtual void flush() = 0;
};

/// See host_on_tty; `line` is for a real terminal ("9600-8N1").
Result<std::unique_ptr<HostPort>> open_tty_port(const std::string& path, const std::string& line);
Result<std::unique_ptr<HostPort>> open_tcp_port(const std::string& host_and_port);

}  // namespace fieldproof::hosting
