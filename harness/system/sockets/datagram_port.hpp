// A datagram port of our own that talks to one port of another host.
#pragma once

#include "harness/system/sockets/connection.hpp"
#include "src/base/result.hpp"

namespace fieldproof::os {

class DatagramPort {
 public:
  /// Takes over a non-blocking datagram socket that is connected.
  explicit DatagramPort(UniqueFd fd) : fd_(std::move(fd)) {}

  /// The next datagram, which may be empty, or `reset`: the host says that nobody has that port.
  std::optional<Arrival> read();
  /// One datagram. Errors: the cause alone: "a datagram holds at most 65507 bytes".
  Status write(ByteView bytes);
  void close() { fd_.reset(); }
  bool is_open() const { return static_cast<bool>(fd_); }
  pollfd to_poll() const { return {fd_.get(), POLLIN, 0}; }

 private:
  UniqueFd fd_;
  bool refused_ = false;
};

}  // namespace fieldproof::os
