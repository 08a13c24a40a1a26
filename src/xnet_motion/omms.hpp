// Time on the motion bus (OMMS): what a servo's parameters make of characters, and which part of
// each refresh period is its own (X-NET 2-6-2). What the manual is silent about: DECISIONS.md
// xnet/omms.
#pragma once

#include <optional>
#include <vector>

#include "src/base/result.hpp"
#include "src/base/time.hpp"
#include "src/xnet_motion/servo.hpp"

namespace fieldproof::xnet {

struct SerialFormat {
  unsigned baud = 0;  // bit/s
  unsigned bits = 0;  // of a character, with start, parity and stop bits

  /// So many characters, transferred with this speed (note 2).
  Duration time_of(unsigned characters) const;
};

/// P7-01. Nothing: the manual does not print what the value means.
std::optional<SerialFormat> serial_format(int p7_01);

/// What a servo may use of each refresh period, counted from its beginning.
struct Slot {
  unsigned axis = 1;
  Duration from{}, to{};
  Duration sends_from{}, sends_to{};  // in the middle (note 3)
};

/// Of the stations 1 to P7-05, one behind the other. `frame`: characters that a servo sends; the
/// manual prints no frame. Errors: the parameter that has no meaning, or slots that are longer than
/// the refresh period (P7-07).
Result<std::vector<Slot>> slots_of(const Servo& servo, unsigned frame);

/// P7-03.
Result<Duration> sampling_time(const Servo& servo);

}  // namespace fieldproof::xnet
