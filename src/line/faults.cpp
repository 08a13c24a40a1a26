#include "src/line/faults.hpp"

#include <algorithm>
#include <utility>

namespace fieldproof::line {

namespace {
Bytes part(const Bytes& bytes, std::size_t from, std::size_t to) {
  const auto begin = bytes.begin();
  const auto size = bytes.size();
  return {begin + static_cast<std::ptrdiff_t>(std::min(from, size)),
          begin + static_cast<std::ptrdiff_t>(std::min(to, size))};
}
}  // namespace

FaultyDevice::FaultyDevice(Device& device, const LineFaults& faults, Duration character_time)
    : device_(device), faults_(faults), character_time_(character_time), random_(faults.seed) {}

void FaultyDevice::receive(const Burst& burst) {
  if (burst.start != request_end_) request_bytes_ = 0;
  const std::size_t first_index = request_bytes_;
  request_end_ = burst.end();
  request_bytes_ += burst.bytes.size();
  if (faults_.echo) queue(burst.end(), burst.bytes);
  hand_on({flipped(burst.bytes, faults_.request, first_index), burst.start, burst.character_time},
          first_index);
}

/// Gives the device what truncation and loss leave of a burst whose first byte has this index.
void FaultyDevice::hand_on(Burst burst, std::size_t first_index) {
  const ByteFaults& faults = faults_.request;
  const std::size_t end_index = first_index + burst.bytes.size();
  if (faults.truncate)
    burst.bytes.resize(std::clamp(*faults.truncate, first_index, end_index) - first_index);
  if (!faults.drop || *faults.drop < first_index ||
      *faults.drop >= first_index + burst.bytes.size()) {
    if (!burst.bytes.empty()) device_.receive(burst);
    return;
  }
  const std::size_t lost = *faults.drop - first_index;
  const Time after = burst.start + static_cast<Duration::rep>(lost + 1) * burst.character_time;
  const Burst head{part(burst.bytes, 0, lost), burst.start, burst.character_time};
  const Burst tail{part(burst.bytes, lost + 1, burst.bytes.size()), after, burst.character_time};
  if (!head.bytes.empty()) device_.receive(head);
  if (!tail.bytes.empty()) device_.receive(tail);
}

std::optional<Time> FaultyDevice::wake_at() const {
  const auto wake = device_.wake_at();
  if (pieces_.empty()) return wake;
  return wake ? std::min(*wake, pieces_.front().start) : pieces_.front().start;
}

Bytes FaultyDevice::advance(Time now) {
  const Bytes reply = device_.advance(now);
  if (!reply.empty()) {
    const Time end = queue_reply(reply, now + faults_.late);
    if (faults_.duplicate) queue_reply(reply, end);
  }
  if (pieces_.empty() || pieces_.front().start > now) return {};
  Bytes bytes = std::move(pieces_.front().bytes);
  pieces_.erase(pieces_.begin());
  return bytes;
}

/// Cuts the reply at a lost byte and at the gap; returns when its time on the wire ends.
Time FaultyDevice::queue_reply(const Bytes& reply, Time start) {
  const ByteFaults& faults = faults_.reply;
  const Bytes sent = flipped(part(reply, 0, faults.truncate.value_or(reply.size())), faults, 0);
  Duration silence{};
  std::size_t from = 0;
  const auto cut = [&](std::size_t to) {
    queue(start + silence + static_cast<Duration::rep>(from) * character_time_,
          part(sent, from, to));
    from = to;
  };
  for (std::size_t i = 0; i < sent.size(); ++i) {
    if (faults.drop == i) {
      cut(i);
      from = i + 1;
    }
    if (faults_.gap_after == i) {
      cut(i + 1);
      silence += faults_.gap;
    }
  }
  cut(sent.size());
  return start + silence + static_cast<Duration::rep>(sent.size()) * character_time_;
}

void FaultyDevice::queue(Time start, Bytes bytes) {
  if (bytes.empty()) return;
  const auto later =
      std::ranges::find_if(pieces_, [start](const Piece& p) { return p.start > start; });
  pieces_.insert(later, Piece{start, std::move(bytes)});
}

Bytes FaultyDevice::flipped(Bytes bytes, const ByteFaults& faults, std::size_t first_index) {
  if (faults.flip && *faults.flip >= first_index && *faults.flip - first_index < bytes.size()) {
    bytes[*faults.flip - first_index] ^= faults.flip_mask;
  }
  if (faults.noise > 0) {
    for (Byte& b : bytes) {
      // Not a standard distribution: those differ between libraries, and a seed must mean one
      // noise.
      const auto draw = random_();
      if (static_cast<double>(draw >> 11) * 0x1p-53 < faults.noise)
        b ^= static_cast<Byte>(1u << (draw & 7));
    }
  }
  return bytes;
}

}  // namespace fieldproof::line
