// What sits on a line: fed with bytes and their arrival time, asked for output and for the next
// moment it wants.
#pragma once

#include <optional>

#include "src/base/bytes.hpp"
#include "src/base/time.hpp"

namespace fieldproof::line {

/// Bytes without a gap between them: byte i occupies [start + i*character_time, start +
/// (i+1)*character_time). Behind a pty or a socket there is no wire time: character_time is 0 and
/// start is the moment of arrival.
struct Burst {
  Bytes bytes;
  Time start{};
  Duration character_time{};

  /// The end of the last stop bit.
  Time end() const { return start + character_time * static_cast<Duration::rep>(bytes.size()); }
};

/// The moments at which a transmission began and its last stop bit ended.
struct Sent {
  Time start{};
  Time end{};
};

/// A server, client, inverter or modem as a state machine on given time. Nothing in it sleeps or
/// asks a clock.
class Device {
 public:
  virtual ~Device() = default;

  /// Feeds a burst. Bursts come in the order of time; `advance` was called for everything due
  /// before `burst.end()`.
  virtual void receive(const Burst& burst) = 0;

  /// The next moment `advance` has something to do, or nothing until bytes arrive.
  virtual std::optional<Time> wake_at() const = 0;

  /// Moves the device's time to `now` and returns the bytes whose transmission begins at `now`
  /// (often none). A device with several frames to send returns the first and asks to be woken
  /// again.
  virtual Bytes advance(Time now) = 0;
};

}  // namespace fieldproof::line
