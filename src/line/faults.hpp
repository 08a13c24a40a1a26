// Faults of a line as a device that wraps another: what the bench sends to it and what it answers
// pass through the fault.
#pragma once

#include <cstddef>
#include <optional>
#include <random>
#include <vector>

#include "src/line/device.hpp"

namespace fieldproof::line {

/// What happens to the bytes of one direction. Bytes count from 0 within a burst (request) or a
/// frame (reply).
struct ByteFaults {
  double noise = 0;                   // probability that a byte has one bit flipped
  std::optional<std::size_t> flip{};  // this byte is XORed with flip_mask
  Byte flip_mask = 0x01;
  std::optional<std::size_t> drop{};      // this byte is lost; its time on the wire stays
  std::optional<std::size_t> truncate{};  // only so many bytes get through
};

struct LineFaults {
  ByteFaults request{};
  ByteFaults reply{};
  bool echo =
      false;  // the request comes back, before the reply (two-wire adapter that hears itself)
  std::optional<std::size_t>
      gap_after{};  // after this byte of each reply the line is silent for `gap`
  Duration gap{};
  Duration late{};         // each reply begins so much later
  bool duplicate = false;  // each reply comes twice, back to back
  std::uint64_t seed = 1;  // of the noise: the same seed gives the same noise
};

class FaultyDevice : public Device {
 public:
  /// `device` must outlive this. `character_time` is that of the line on which it transmits.
  FaultyDevice(Device& device, const LineFaults& faults, Duration character_time);

  void receive(const Burst& burst) override;
  std::optional<Time> wake_at() const override;
  Bytes advance(Time now) override;

 private:
  struct Piece {
    Time start{};
    Bytes bytes;
  };
  Bytes flipped(Bytes bytes, const ByteFaults& faults, std::size_t first_index);
  void hand_on(Burst burst, std::size_t first_index);
  Time queue_reply(const Bytes& reply, Time start);
  void queue(Time start, Bytes bytes);

  Device& device_;
  LineFaults faults_;
  Duration character_time_;
  std::mt19937_64 random_;
  std::vector<Piece> pieces_;  // in the order of transmission
  Time request_end_{-1};
  std::size_t request_bytes_ = 0;  // of the burst so far: the line may hand it over in parts
};

}  // namespace fieldproof::line
