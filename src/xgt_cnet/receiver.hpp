// Finds frames in what arrives: header, tail, BCC, and the inter-character time (Cnet KO 4.3.1).
#pragma once

#include <optional>

#include "src/base/bytes.hpp"
#include "src/line/device.hpp"
#include "src/line/silence.hpp"
#include "src/plc/frame_sink.hpp"

namespace fieldproof::xgt_cnet {

/// A frame: header to tail, and BCC after a lower-case command; it ends with its last stop bit.
/// No frame: service_status::head (bytes outside a frame, once a run of them), tail, or bcc (the
/// BCC never came).
class FrameReceiver {
 public:
  /// From the header on; more without a tail is dropped (DECISIONS.md cnet/receive-buffer).
  static constexpr std::size_t max_frame = 1024;

  /// A server receives ENQ ... EOT, a client ACK or NAK ... ETX.
  enum class Side { server, client };

  /// A silence longer than `gap` between two characters ends a frame.
  FrameReceiver(Side side, Duration gap);

  void receive(const Burst& burst, plc::FrameSink& sink);
  /// When the silence has become too long even for a character that is arriving at that moment.
  std::optional<Time> wake_at() const;
  void advance(Time now, plc::FrameSink& sink);
  /// As after power on.
  void reset();

 private:
  enum class State { idle, garbage, frame, bcc };

  bool is_head(Byte b) const;
  void take(Byte b, Time end, plc::FrameSink& sink);
  void give_up(plc::FrameSink& sink);

  Side side_;
  Byte tail_;
  line::Silence silence_;
  State state_ = State::idle;
  int bcc_missing_ = 0;
  Bytes frame_;
};

}  // namespace fieldproof::xgt_cnet
