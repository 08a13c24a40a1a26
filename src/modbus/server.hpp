// The Modbus RTU or ASCII server of one Cnet channel (Cnet EN and KO 6.1.3 and chapter 9;
// DECISIONS.md 'Modbus RTU and ASCII').
//
// It answers in RUN and STOP, and to its own station alone: a request to station 0 draws silence
// from any other server and changes nothing. What draws silence is counted (service_status in
// src/plc/counters.hpp); an exception is a service. The reply is due when the end of the request is
// known, and after the delay: in RTU that is the inter-character time and one character after its
// last byte (rtu_receiver.hpp).
#pragma once

#include <memory>

#include "src/modbus/data_space.hpp"
#include "src/modbus/receiver.hpp"
#include "src/plc/port_config.hpp"
#include "src/plc/reply_queue.hpp"
#include "src/plc/service.hpp"

namespace fieldproof::modbus {

class ModbusServer : public plc::LineService, private plc::FrameSink {
 public:
  /// rtu or ascii.
  ModbusServer(ModbusMode mode, std::unique_ptr<DataSpace> data, const plc::PortConfig& port)
      : mode_(mode),
        station_(port.station),
        delay_(port.reply_delay()),
        data_(std::move(data)),
        receiver_(make_modbus_receiver(mode, port.gap())) {}

  void receive(const Burst& burst) override { receiver_->receive(burst, *this); }
  std::optional<Time> wake_at() const override { return replies_.wake_at(receiver_->wake_at()); }
  Bytes advance(Time now) override;

  const plc::ServiceCounters& counters() const override { return counters_; }
  /// Counters, replies and frames in progress are lost.
  void power_cycle() override;

 private:
  void on_frame(ByteView bytes, Time end) override;
  void on_broken_frame(std::uint16_t why) override { counters_.count_error(why); }

  ModbusMode mode_;
  unsigned station_;
  Duration delay_;
  std::unique_ptr<DataSpace> data_;
  std::unique_ptr<ModbusReceiver> receiver_;
  plc::ServiceCounters counters_;
  plc::ReplyQueue replies_;
};

}  // namespace fieldproof::modbus
