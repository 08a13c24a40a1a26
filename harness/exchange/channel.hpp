// A way to a server of the device under test, and what endpoints say of links.
#pragma once

#include <optional>

#include "harness/endpoints/endpoint.hpp"
#include "harness/protocol.hpp"

namespace fieldproof::exchange {

/// Nothing is owned.
struct Channel {
  endpoints::Endpoint* endpoint = nullptr;  // none
  const harness::Protocol* protocol = nullptr;
  int station = 1;

  explicit operator bool() const { return endpoint != nullptr; }
};

/// How a link is opened that nobody has described; nothing: there is a line, always open.
inline std::optional<Transport> implicit_transport(const Channel& to) {
  if (!to.protocol->on_network()) return std::nullopt;
  const endpoints::Capabilities& can = to.endpoint->capabilities();
  if (can.connections) return Transport::tcp;
  return can.datagrams ? std::optional(Transport::udp) : std::nullopt;
}

/// The deadline has passed.
inline bool is_nothing(const Burst& burst) {
  return burst.bytes.empty() && burst.event == LinkEvent::data;
}
/// The device has ended the link.
inline bool is_end(const Burst& burst) {
  return burst.event == LinkEvent::closed || burst.event == LinkEvent::reset;
}

}  // namespace fieldproof::exchange
