#include "src/modbus/rtu_receiver.hpp"

#include <algorithm>
#include <utility>

#include "src/modbus/frame.hpp"
#include "src/plc/counters.hpp"

namespace fieldproof::modbus {

void RtuReceiver::receive(const Burst& burst, plc::FrameSink& sink) {
  if (burst.bytes.empty()) return;
  if (silence_.is_over_before(burst)) finish(sink);
  const std::size_t room = rtu_max_frame + 1 - frame_.size();
  const auto taken = static_cast<std::ptrdiff_t>(std::min(room, burst.bytes.size()));
  frame_.insert(frame_.end(), burst.bytes.begin(), burst.bytes.begin() + taken);
  silence_.heard(burst);
}

std::optional<Time> RtuReceiver::wake_at() const {
  if (frame_.empty()) return std::nullopt;
  return silence_.over_at();
}

void RtuReceiver::advance(Time now, plc::FrameSink& sink) {
  if (const auto wake = wake_at(); wake && now >= *wake) finish(sink);
}

void RtuReceiver::finish(plc::FrameSink& sink) {
  if (frame_.empty()) return;
  const Time end = *wake_at();
  const Bytes frame = std::exchange(frame_, {});
  if (frame.size() > rtu_max_frame)
    sink.on_broken_frame(plc::service_status::too_long);
  else
    sink.on_frame(frame, end);
}

}  // namespace fieldproof::modbus
