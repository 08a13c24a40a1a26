// What a receiver makes of the levels on a line, bit by bit: the sender's start, data (least
// significant first), parity and stop bits are a level over time; the receiver hunts a falling
// edge, confirms it half a bit later, and samples each bit in its middle by its own clock. So
// mismatched settings and collisions give the bytes and errors that a UART gives.
#pragma once

#include <optional>
#include <vector>

#include "src/base/time.hpp"
#include "src/line/device.hpp"
#include "src/line/settings.hpp"

namespace fieldproof::line {

/// Characters that a receiver has dropped. One character may count as both.
struct LineErrors {
  int parity = 0;
  int framing = 0;

  bool operator==(const LineErrors&) const = default;
};

/// The level that one receiver sees. Several transmissions at once: low wins (the AND of the
/// levels). Idle is high.
class Waveform {
 public:
  /// `burst` and `sender` must outlive the waveform. `burst.character_time` is the sender's
  /// character time.
  void add(const Burst& burst, const LineSettings& sender);
  /// The receiver is off in [from, until) and reads idle (half duplex: it transmits itself).
  void mute(Time from, Time until);

  bool high(Time t) const;
  /// The first moment at or after `from` at which the level falls.
  std::optional<Time> falling_edge(Time from) const;

 private:
  struct Source {
    const Burst* burst;
    const LineSettings* sender;
  };
  struct Interval {
    Time from, until;
  };
  std::optional<Time> next_boundary(Time from) const;

  std::vector<Source> sources_;
  std::vector<Interval> muted_;
};

/// One character as sampled.
struct Character {
  Byte value = 0;
  Time start{};      // the falling edge
  Time end{};        // start and the receiver's character time
  Time hunt_from{};  // the middle of the first stop bit: from here the receiver looks for the next
                     // edge
  bool parity_error = false;
  bool framing_error =
      false;  // the first stop bit was low; further stop bits are not looked at, as in real UARTs

  bool good() const { return !parity_error && !framing_error; }
};

/// The first character whose start bit falls at or after `from`; nothing when the rest of the line
/// is idle.
std::optional<Character> next_character(const Waveform& wave, const LineSettings& receiver,
                                        Time from);

struct Reading {
  std::vector<Burst> bursts;  // good characters; those that follow without a gap are one burst
  LineErrors errors;
};

/// What a receiver makes of one burst on an otherwise idle line. Equal settings: the burst itself.
Reading read_burst(const Burst& burst, const LineSettings& sender, const LineSettings& receiver);

/// The bytes as a sender with these settings can carry them: 7 data bits drop bit 7.
void drop_unsent_bits(Bytes& bytes, const LineSettings& sender);

}  // namespace fieldproof::line
