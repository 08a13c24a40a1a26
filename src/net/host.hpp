// A device on a network, as a state machine on given time: what arrives on its links, and what it
// does on them. As src/line/device.hpp is for a serial line.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "src/base/burst.hpp"

namespace fieldproof::net {

/// What arrives, and what the host does, are bursts (src/base/burst.hpp), each on a link:
// clang-format off
///   event     arrives                              the host does it
///   opened    a client has connected to `port`;    it connects to `port` of `peer`, on a link of
///             the link is new                      its own (first_own_link and up, never twice)
///   data      bytes of a connection, in any        bytes; those for a link that is gone are lost
///             pieces
///   datagram  one datagram to `port` from `peer`;  an answer on the link that it came on, or one
///             a link is one peer of one port       of its own to `port` of `peer`
///   closed    the client sends no more (FIN)       it sends no more, and still hears
///   reset     the link is gone, or the connection  the link is gone at once (RST); also of a
///             of its own was refused               client that it does not want
// clang-format on
///
/// A link is gone after a reset by either side, and after both have closed. Nothing arrives on it
/// then. A connection of the host's own may be used at once: bytes go out when it stands. Whether
/// it stands is not told, only that it was refused.
class Host {
 public:
  virtual ~Host() = default;

  /// A connection to a port that does not listen is refused; a datagram to one is lost.
  virtual bool listens(Transport transport, std::uint16_t port) const = 0;

  /// Bursts come in the order of time; `advance` was called for everything due before
  /// `burst.start`. character_time is 0.
  virtual void receive(const Burst& burst) = 0;

  /// The next moment `advance` has something to do, or nothing until something arrives.
  virtual std::optional<Time> wake_at() const = 0;

  /// Moves the host's time to `now`: what it does at `now`, in this order.
  virtual std::vector<Burst> advance(Time now) = 0;
};

}  // namespace fieldproof::net
