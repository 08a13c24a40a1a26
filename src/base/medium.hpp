// A simulated way between the bench and devices, on given time: a line or a network.
#pragma once

#include <optional>
#include <span>

#include "src/base/burst.hpp"

namespace fieldproof {

/// Nothing in it waits. `run` never goes beyond `next_event`, where that is earlier than `until`,
/// so several media of one device can run in step.
class Medium {
 public:
  virtual ~Medium() = default;

  virtual Time now() const = 0;
  /// The next moment, not before `now()`, at which something happens; nothing: never, unless the
  /// bench or another medium does something.
  virtual std::optional<Time> next_event() const = 0;
  /// Everything that is due until `until`, and at that moment. It ends earlier where the bench has
  /// heard something: at that moment, and what else is due then happens in the next call.
  virtual void run(Time until) = 0;
  /// What the bench has heard first, or nothing.
  virtual std::optional<Burst> take() = 0;
  /// A part of what the bench is hearing at this moment; empty where it hears nothing.
  virtual std::optional<Burst> take_part() { return std::nullopt; }
};

/// What the bench hears next on any of them, which are all at one moment before and after. Nothing
/// heard: an empty burst, and all stand at `until` (a moment in the past: where they are).
Burst receive_in_step(std::span<Medium* const> media, Time until);

}  // namespace fieldproof
