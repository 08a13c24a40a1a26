// RTU frames: silence alone tells one from the next (Cnet EN and KO 9.3.2 (1)(d); Cnet KO 4.3.1).
//
// A gap shorter than the inter-character time (0: 3.5 characters of 11 bits) keeps a frame
// together, also between 1.5 characters and that time: there Cnet KO 4.3.1 is followed ('characters
// that come within the time are one frame'), not 9.3.2 ('exceeding 1.5 character time'). A gap
// equal to the time, or longer, ends it. That is known one character later than the time alone: a
// character that began within it has arrived by then.
#pragma once

#include "src/line/silence.hpp"
#include "src/modbus/receiver.hpp"

namespace fieldproof::modbus {

class RtuReceiver : public ModbusReceiver {
 public:
  explicit RtuReceiver(Duration gap) : silence_(gap - Duration(1)) {}

  /// Frames have at most rtu_max_frame bytes; a longer one is dropped (service_status::too_long).
  /// The `end` of a frame is the moment at which its end is known.
  void receive(const Burst& burst, plc::FrameSink& sink) override;
  std::optional<Time> wake_at() const override;
  void advance(Time now, plc::FrameSink& sink) override;
  void reset() override { frame_.clear(); }

 private:
  void finish(plc::FrameSink& sink);

  line::Silence silence_;
  Bytes frame_;  // one byte more than the longest at most
};

}  // namespace fieldproof::modbus
