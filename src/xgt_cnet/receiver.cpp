#include "src/xgt_cnet/receiver.hpp"

#include "src/base/letters.hpp"
#include "src/plc/counters.hpp"
#include "src/xgt_cnet/codec.hpp"

namespace fieldproof::xgt_cnet {

namespace {
constexpr std::size_t command_at = 3;
constexpr int bcc_size = 2;
}  // namespace

FrameReceiver::FrameReceiver(Side side, Duration gap)
    : side_(side), tail_(side == Side::server ? xgt_eot : xgt_etx), silence_(gap) {
  frame_.reserve(64);
}

bool FrameReceiver::is_head(Byte b) const {
  return side_ == Side::server ? b == xgt_enq : b == xgt_ack || b == xgt_nak;
}

void FrameReceiver::receive(const Burst& burst, plc::FrameSink& sink) {
  if (silence_.is_over_before(burst)) give_up(sink);
  burst.for_each([&](Byte b, Time end) { take(b, end, sink); });
  silence_.heard(burst);
}

void FrameReceiver::take(Byte b, Time end, plc::FrameSink& sink) {
  if (is_head(b)) {
    give_up(sink);
    frame_.assign(1, b);
    state_ = State::frame;
    return;
  }
  switch (state_) {
    case State::idle:
      state_ = State::garbage;
      sink.on_broken_frame(plc::service_status::head);
      [[fallthrough]];
    case State::garbage: return;
    case State::frame:
      if (frame_.size() == max_frame) {
        state_ = State::garbage;  // already counted
        sink.on_broken_frame(plc::service_status::tail);
        return;
      }
      frame_.push_back(b);
      if (b != tail_) return;
      if (frame_.size() > command_at && is_lower(static_cast<char>(frame_[command_at]))) {
        state_ = State::bcc;
        bcc_missing_ = bcc_size;
        return;
      }
      break;
    case State::bcc:
      frame_.push_back(b);
      if (--bcc_missing_ > 0) return;
      break;
  }
  state_ = State::idle;
  sink.on_frame(frame_, end);
}

void FrameReceiver::give_up(plc::FrameSink& sink) {
  if (state_ == State::frame) sink.on_broken_frame(plc::service_status::tail);
  if (state_ == State::bcc) sink.on_broken_frame(plc::service_status::bcc);
  state_ = State::idle;
}

std::optional<Time> FrameReceiver::wake_at() const {
  if (state_ == State::idle || state_ == State::garbage) return std::nullopt;
  return silence_.over_at();
}

void FrameReceiver::advance(Time now, plc::FrameSink& sink) {
  if (now >= wake_at().value_or(Time::max())) give_up(sink);
}

void FrameReceiver::reset() { state_ = State::idle; }

}  // namespace fieldproof::xgt_cnet
