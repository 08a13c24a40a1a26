// Requests beside the steps of a case: the sanity exchange, the floor, memory that is set or looked
// at. On a line they go over the line; on a network over a connection of their own that is closed
// after use, so that it does not stay one of the few that a device takes.
#pragma once

#include <functional>
#include <optional>

#include "harness/exchange/channel.hpp"

namespace fieldproof::exchange {

class Visit {
 public:
  /// What comes on links that are not the visit's; without it such is dropped.
  using Elsewhere = std::function<void(Burst)>;

  explicit Visit(const Channel& to, Elsewhere elsewhere = {});
  ~Visit() { leave(); }
  Visit(const Visit&) = delete;
  Visit& operator=(const Visit&) = delete;

  /// Goes over this link of the case, which stays open, instead of over one of its own.
  void borrow(LinkId link);

  /// Opens what it needs. Errors are those of the endpoint.
  Result<Sent> send(ByteView bytes);
  /// The next bytes; none when `deadline` has passed or the device has ended the connection.
  Result<Burst> receive(Time deadline);
  /// How the device ended, or refused, the connection of the last request.
  std::optional<LinkEvent> ended() const { return ended_; }
  /// Nothing came over the connection of the last request before the device reset it.
  bool refused() const { return ended_ == LinkEvent::reset && !heard_; }

  /// Lets time pass.
  Status pause(Duration duration);
  /// Closes what it opened.
  void leave();

 private:
  Status enter();
  void hand_over(Burst burst);

  endpoints::Endpoint& endpoint_;
  Elsewhere elsewhere_;
  std::optional<Transport> transport_;  // of connections of its own; none: a line
  std::optional<LinkId> link_;
  bool own_ = false;    // opened here
  bool heard_ = false;  // anything, since the link was entered
  std::optional<LinkEvent> ended_;
};

}  // namespace fieldproof::exchange
