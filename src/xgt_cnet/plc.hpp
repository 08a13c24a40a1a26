// An emulated XGB PLC as XGT Cnet server: one model's memory behind one Cnet channel.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "src/plc/emulated_device.hpp"
#include "src/plc/memory.hpp"
#include "src/plc/port_config.hpp"
#include "src/xgt_cnet/server.hpp"

namespace fieldproof::xgt_cnet {

class Plc : public plc::EmulatedDevice {
 public:
  Plc(const Plc&) = delete;
  Plc& operator=(const Plc&) = delete;

  void receive(const Burst& burst) override { server_.receive(burst); }
  std::optional<Time> wake_at() const override { return server_.wake_at(); }
  Bytes advance(Time now) override { return server_.advance(now); }

  Status set(std::string_view address, std::string_view hex) override {
    return plc::set_by_name(memory_, address, hex);
  }
  Result<std::string> get(std::string_view address, std::size_t digits) const override;
  /// power_cycle: registrations, counters and frames in progress are lost; memory stays. A server
  /// answers in RUN and STOP.
  Status act(std::string_view action) override;

 private:
  friend Result<std::unique_ptr<Plc>> make_plc(const plc::PortConfig& config);
  Plc(const plc::PlcModel& model, const plc::PortConfig& config)
      : memory_(model), server_(memory_, config.station, config.gap(), config.reply_delay()) {}

  plc::PlcMemory memory_;
  XgtServer server_;
};

/// In its power-on state. Errors name the model, or the parameter that is out of its range.
Result<std::unique_ptr<Plc>> make_plc(const plc::PortConfig& config);

}  // namespace fieldproof::xgt_cnet
