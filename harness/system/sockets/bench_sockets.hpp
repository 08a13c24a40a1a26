// The bench's side of a network: its links over real sockets, on the clock of the run.
#pragma once

#include <string>

#include "harness/system/fd_link.hpp"
#include "harness/system/sockets/socket_links.hpp"

namespace fieldproof::os {

class BenchSockets {
 public:
  /// `name` is for messages: "tcp:plc:502".
  explicit BenchSockets(std::string name) : name_(std::move(name)) {}

  /// A process that the links depend on: its end is an error of send and receive. It outlives this
  /// or is replaced first; nullptr: none.
  void set_far_end(FarEnd* far_end) { far_end_ = far_end; }
  /// How long a send waits for a far end that takes no bytes.
  void set_send_limit(Duration limit) { send_limit_ = limit; }

  /// A link over a socket of `RemoteHost::connect`, to `port`; of one without a descriptor all that
  /// comes is `reset`.
  LinkId add(Transport transport, UniqueFd socket, std::uint16_t port);
  /// Links that the device opens (first_own_link and up), over a socket of `listen_socket`.
  void listen(UniqueFd socket, Transport transport, std::uint16_t port) {
    links_.listen(std::move(socket), transport, port);
  }

  /// As those of an Endpoint.
  Time now() const { return clock_.now(); }
  Status close(LinkId link, Closing how);
  Result<Sent> send(ByteView bytes, LinkId link);
  Result<Burst> receive(Time deadline);

  /// Ends all links, those that the device has opened too, and goes on listening.
  void end_all() { links_.end_all(); }
  /// The same where the device has lost its power: what is next sent on a connection meets a reset.
  void lose_all() { links_.lose_all(); }
  /// Ends those that this side has closed; what still comes on them is not told.
  void end_closed() { links_.end_closed(); }

 private:
  Result<bool> wait(Time deadline, bool hearing);
  Error ended(const char* verb);
  Burst stamped(Burst burst) const;

  std::string name_;
  RunClock clock_;
  FarEnd* far_end_ = nullptr;
  Duration send_limit_ = 3s;
  SocketLinks links_{first_own_link};
  LinkId next_link_ = line_link + 1;
  struct Target {
    std::uint16_t port = 0;
    std::string peer;
  };
  std::map<LinkId, Target> targets_;  // of datagram ports
  std::vector<pollfd> fds_;           // of the present wait
};

}  // namespace fieldproof::os
