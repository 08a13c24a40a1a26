// All links of one side over real sockets: connections and datagram ports, its own and those that
// others open.
#pragma once

#include <poll.h>

#include <deque>
#include <map>
#include <set>
#include <span>
#include <vector>

#include "harness/system/sockets/connection.hpp"
#include "harness/system/sockets/datagram_port.hpp"
#include "harness/system/sockets/datagram_server.hpp"
#include "src/base/result.hpp"

namespace fieldproof::os {

/// Never waits: who waits polls what `add_to` gives, hands the answer to `heard`, and takes. Reads
/// only what has something to read. One thread.
class SocketLinks {
 public:
  /// Links that others open are numbered from `first_link` on.
  explicit SocketLinks(LinkId first_link) : next_link_(first_link) {}

  /// A link of this side's own, of a number that was never used.
  void add(LinkId link, Connection connection);
  void add(LinkId link, DatagramPort port);
  /// Is or was it opened here?
  bool has(LinkId link) const {
    return connections_.contains(link) || over_.contains(link) || ports_.contains(link) ||
           lost_.contains(link);
  }
  /// Is it a connection that neither waits for the other side's yes nor has ended, or a datagram
  /// port?
  bool stands(LinkId link) const;
  /// Takes over a socket of `listen_socket`; its connections and datagrams are said to be to
  /// `port`.
  void listen(UniqueFd socket, Transport transport, std::uint16_t port);

  /// What came next on any link, or nothing; `start` is left to the caller. What came on links that
  /// stand comes before a connection that was opened later.
  std::optional<Burst> take();

  /// Bytes of a connection, or one datagram. What the other side no longer wants is dropped. Errors
  /// are the cause alone: "the link is not open".
  Status send(LinkId link, ByteView bytes);
  /// Errors as those of `send`.
  Status close(LinkId link, Closing how);
  /// Sends what waits; does more of that link wait?
  bool flush(LinkId link);
  /// The same of all links.
  void flush();

  /// Ends all links, those that wait to be accepted too, and goes on listening.
  void end_all();
  /// The same where the other side has lost its power: of its connections it knows nothing any
  /// more, so what is next sent on one is answered by a reset.
  void lose_all();
  /// Ends the connections that this side has closed, whatever the other one has still to say.
  void end_closed();
  /// What to wait for; `hearing` false: that something can be sent again.
  void add_to(std::vector<pollfd>& fds, bool hearing = true) const;
  /// What came of it: `answers` begin with those of `add_to` (hearing), after which nothing was
  /// done here.
  void heard(std::span<const pollfd> answers);

 private:
  // `ready`: something may be there; what is new is looked at once.
  struct Listener {
    UniqueFd fd;
    std::uint16_t port = 0;
    bool ready = true;
  };
  struct Link {
    Connection connection;
    std::uint16_t port = 0;  // of one that others have opened
    std::string peer{};
    bool ready = true;
  };
  struct Port {
    DatagramPort port;
    bool ready = true;
  };
  struct Server {
    DatagramServer server;
    bool ready = true;
  };

  std::optional<Burst> take_of_links();
  std::optional<Burst> take_of_datagrams();
  void look_at_all_connections();
  void accept_waiting();
  bool is_untold(LinkId link) const;
  bool has_room() const;
  /// Connections that are over are looked at no more.
  void put_aside();

  LinkId next_link_;
  LinkId last_ = line_link;  // that something was taken of
  std::map<LinkId, Link> connections_;
  std::map<LinkId, bool> over_;  // connections that are; is this side open? What it sends is lost
  std::map<LinkId, Port> ports_;
  std::set<LinkId> lost_;  // connections whose other side has lost its power
  std::vector<Listener> listeners_;
  std::vector<Server> servers_;
  std::deque<Burst> accepted_;  // that nobody has been told of
};

}  // namespace fieldproof::os
