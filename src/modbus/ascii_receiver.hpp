// ASCII frames: ':' to CR LF, at most one second between two characters (Cnet EN and KO 9.3.1 (1)).
//
// ':' inside a frame begins a new one. What stands between is not looked at here. The
// inter-character parameter of Cnet KO 4.3.1 does not apply: its default of 3.5 characters would
// contradict the second.
#pragma once

#include "src/line/silence.hpp"
#include "src/modbus/receiver.hpp"

namespace fieldproof::modbus {

class AsciiReceiver : public ModbusReceiver {
 public:
  /// Longest silence between two characters.
  static constexpr Duration max_gap = 1s;

  /// Frames have at most ascii_max_frame characters; a longer one is dropped
  /// (service_status::too_long). Characters outside a frame (once a run of them), and a frame
  /// without its end, are service_status::not_modbus.
  void receive(const Burst& burst, plc::FrameSink& sink) override;
  std::optional<Time> wake_at() const override;
  void advance(Time now, plc::FrameSink& sink) override;
  void reset() override { state_ = State::idle; }

 private:
  enum class State { idle, garbage, frame };

  void take(Byte b, Time end, plc::FrameSink& sink);
  void give_up(plc::FrameSink& sink);

  State state_ = State::idle;
  Bytes frame_;
  line::Silence silence_{max_gap};
};

}  // namespace fieldproof::modbus
