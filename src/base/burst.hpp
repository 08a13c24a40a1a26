// What crosses between the bench and a device under test: bytes, the link they are on, and how
// links open and end. A serial line is one link that never opens or closes; a network device has
// many.
#pragma once

#include <cstdint>
#include <string>

#include "src/base/bytes.hpp"
#include "src/base/time.hpp"

namespace fieldproof {

/// One way between bench and device: the serial line, a connection, a datagram port of the bench.
/// Ids are given out in rising order and never used again within one endpoint.
using LinkId = std::uint32_t;
/// The serial line. It is always there.
inline constexpr LinkId line_link = 0;
/// Links that the device itself opens are numbered from here on, by the device.
inline constexpr LinkId first_own_link = LinkId{1} << 31;

enum class LinkEvent : Byte {
  data,      // bytes of a line or a connection
  datagram,  // one whole datagram, which may be empty
  opened,    // the other side has connected; no bytes
  closed,    // the other side sends no more (FIN); what it sent before has come
  reset      // the link is gone at once (RST), or a connection was refused
};

/// Bytes without a gap between them: byte i occupies [start + i*character_time, start +
/// (i+1)*character_time). Behind a pty or a socket there is no wire time: character_time is 0 and
/// start is the moment of arrival.
struct Burst {
  Bytes bytes;
  Time start{};
  Duration character_time{};
  LinkId link = line_link;
  LinkEvent event = LinkEvent::data;
  std::uint16_t port = 0;  // opened, datagram: the port of the side that listens
  std::string peer{};      // opened, datagram: the other side as "ADDRESS:PORT", where it is known

  /// The end of the last stop bit.
  Time end() const { return start + character_time * static_cast<Duration::rep>(bytes.size()); }

  /// Gives `take` each byte, and the end of that byte's stop bit.
  void for_each(auto&& take) const {
    Time end = start;
    for (const Byte b : bytes) take(b, end += character_time);
  }
};

/// The moments at which a transmission began and its last stop bit ended.
struct Sent {
  Time start{};
  Time end{};
};

enum class Transport : Byte { tcp, udp };

/// How the bench ends a connection: FIN (nothing more will be sent, what comes is still read), RST,
/// or not at all: a client that vanishes answers nothing from then on.
enum class Closing : Byte { fin, rst, vanish };

}  // namespace fieldproof
