// The bench and several stations on one multi-drop line, in simulated time. Everyone hears everyone
// else: stations hear the replies of other stations too. It carries whole bursts; only where
// settings differ or transmissions collide does it look at single bits (uart.hpp).
#pragma once

#include <optional>
#include <vector>

#include "src/base/medium.hpp"
#include "src/line/device.hpp"
#include "src/line/settings.hpp"
#include "src/line/uart.hpp"

namespace fieldproof::line {

/// May one who transmits hear another who does at the same time? RS-232 and RS-422: full; two-wire
/// RS-485: half.
enum class Duplex { full, half };

class SimulatedLine : public Medium {
 public:
  struct Transmitted {
    Time start{};
    Time end{};  // the end of the last stop bit
  };

  explicit SimulatedLine(const LineSettings& bench, Duplex duplex = Duplex::full, Time now = {});

  /// Adds a station and advances it to `now()`: it is switched on at this moment. The device must
  /// outlive the line.
  void attach(Device& device, const LineSettings& settings);

  Time now() const override { return now_; }
  const LineSettings& bench_settings() const { return listeners_.front().settings; }

  /// The bench transmits now. `now()` then stands at the end of the last stop bit, so a second call
  /// is back to back, and everything due until then, and at that moment, has happened: a reply
  /// without delay has begun.
  Transmitted transmit(ByteView bytes);
  /// The same without letting time pass: for lines that run in step with other media.
  Transmitted begin_to_transmit(ByteView bytes);

  /// The next burst that the bench hears; `now()` then stands at its end. A burst that is not
  /// complete at `until` comes in parts. Nothing heard: an empty burst, and `now()` stands at
  /// `until`. Time never goes back: with `until` in the past it takes what has been heard.
  Burst receive(Time until);

  std::optional<Time> next_event() const override;
  void run(Time until) override { run(until, true); }
  std::optional<Burst> take() override;
  std::optional<Burst> take_part() override;

  /// Characters that the bench has dropped since the last call.
  LineErrors take_errors();

 private:
  /// Index 0 is the bench.
  struct Listener {
    Device* device = nullptr;
    LineSettings settings;
    Time heard{};            // on the fast path: the end of the last character it was given
    bool bit_exact = false;  // someone on the air has other settings, or collides with another
    Time hunt_from{};        // bit_exact: where its receiver looks for the next start bit
    Time transmits_until{};
  };
  struct OnAir {
    std::size_t sender = 0;
    Burst burst;
    bool over =
        false;  // heard by all on the fast path; kept for receivers that are still inside it
  };

  void run(Time until, bool until_heard);
  Time next_event(Time until) const;
  void finish_transmissions();
  bool hear_characters();
  void forget_transmissions();
  void wake_stations();
  void begin_transmission(std::size_t sender, Bytes bytes);

  bool on_fast_path(std::size_t listener) const;
  bool hear(std::size_t listener);
  void deliver(std::size_t listener, const Burst& burst);
  std::optional<Character> character_for(std::size_t listener) const;

  Duplex duplex_;
  Time now_;
  std::vector<Listener> listeners_;
  std::vector<OnAir> on_air_;
  std::vector<Burst> inbox_;  // heard by the bench, oldest first
  LineErrors errors_;
  bool any_bit_exact_ = false;
  Burst part_;  // reused for parts of a burst
};

}  // namespace fieldproof::line
