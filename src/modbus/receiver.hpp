// Finds Modbus frames in what arrives. What it finds goes to decode_modbus_frame (frame.hpp).
#pragma once

#include <memory>
#include <optional>

#include "src/line/device.hpp"
#include "src/modbus/modbus_mode.hpp"
#include "src/plc/frame_sink.hpp"

namespace fieldproof::modbus {

class ModbusReceiver {
 public:
  virtual ~ModbusReceiver() = default;

  virtual void receive(const Burst& burst, plc::FrameSink& sink) = 0;
  /// When silence has ended the frame in progress.
  virtual std::optional<Time> wake_at() const = 0;
  virtual void advance(Time now, plc::FrameSink& sink) = 0;
  /// As after power on.
  virtual void reset() = 0;
};

/// `gap`: the inter-character time, by which RTU frames end. ASCII has a second of its own, TCP
/// none.
std::unique_ptr<ModbusReceiver> make_modbus_receiver(ModbusMode mode, Duration gap);

}  // namespace fieldproof::modbus
