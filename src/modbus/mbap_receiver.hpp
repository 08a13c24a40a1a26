// Finds Modbus TCP frames in the stream of one connection: the length alone says where one ends
// (FEnet EN 5.3.3). A frame may come in any pieces; several may come at once.
#pragma once

#include "src/modbus/receiver.hpp"

namespace fieldproof::modbus {

class MbapReceiver : public ModbusReceiver {
 public:
  /// A frame of another protocol is one, too. A length that none has (mbap.hpp) is broken:
  /// service_status::not_modbus, or too_long; nothing behind it can be found until `reset`.
  void receive(const Burst& burst, plc::FrameSink& sink) override;
  std::optional<Time> wake_at() const override { return std::nullopt; }
  void advance(Time, plc::FrameSink&) override {}
  void reset() override;

 private:
  Bytes heard_;
  bool lost_ = false;
};

}  // namespace fieldproof::modbus
