// What sits on a line: fed with bytes and their arrival time, asked for output and for the next
// moment it wants.
#pragma once

#include <optional>

#include "src/base/burst.hpp"

namespace fieldproof::line {

/// A server, client, inverter or modem as a state machine on given time. Nothing in it sleeps or
/// asks a clock.
class Device {
 public:
  virtual ~Device() = default;

  /// Feeds a burst of bytes on the line (LinkEvent::data on line_link). Bursts come in the order of
  /// time; `advance` was called for everything due before `burst.end()`.
  virtual void receive(const Burst& burst) = 0;

  /// The next moment `advance` has something to do, or nothing until bytes arrive.
  virtual std::optional<Time> wake_at() const = 0;

  /// Moves the device's time to `now` and returns the bytes whose transmission begins at `now`
  /// (often none). A device with several frames to send returns the first and asks to be woken
  /// again.
  virtual Bytes advance(Time now) = 0;
};

}  // namespace fieldproof::line
