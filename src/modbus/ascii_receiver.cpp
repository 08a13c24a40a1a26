#include "src/modbus/ascii_receiver.hpp"

#include "src/modbus/frame.hpp"
#include "src/plc/counters.hpp"

namespace fieldproof::modbus {

void AsciiReceiver::receive(const Burst& burst, plc::FrameSink& sink) {
  if (burst.bytes.empty()) return;
  if (silence_.is_over_before(burst)) give_up(sink);
  burst.for_each([&](Byte b, Time end) { take(b, end, sink); });
  silence_.heard(burst);
}

void AsciiReceiver::take(Byte b, Time end, plc::FrameSink& sink) {
  if (b == ':') {
    give_up(sink);
    frame_.assign(1, b);
    state_ = State::frame;
    return;
  }
  if (state_ == State::garbage) return;
  if (state_ == State::idle) {
    state_ = State::garbage;
    return sink.on_broken_frame(plc::service_status::not_modbus);
  }
  if (frame_.size() == ascii_max_frame) {
    state_ = State::garbage;  // already counted
    return sink.on_broken_frame(plc::service_status::too_long);
  }
  const bool ends = b == '\n' && frame_.back() == '\r';
  frame_.push_back(b);
  if (!ends) return;
  state_ = State::idle;
  sink.on_frame(frame_, end);
}

void AsciiReceiver::give_up(plc::FrameSink& sink) {
  if (state_ == State::frame) sink.on_broken_frame(plc::service_status::not_modbus);
  state_ = State::idle;
}

std::optional<Time> AsciiReceiver::wake_at() const {
  if (state_ != State::frame) return std::nullopt;
  return silence_.over_at();
}

void AsciiReceiver::advance(Time now, plc::FrameSink& sink) {
  if (const auto wake = wake_at(); wake && now >= *wake) give_up(sink);
}

}  // namespace fieldproof::modbus
