// An emulated XGB PLC: one model's memory behind one Cnet channel, as server or P2P client.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "src/plc/emulated_device.hpp"
#include "src/plc/memory.hpp"
#include "src/xgt_cnet/client.hpp"
#include "src/xgt_cnet/plc_config.hpp"
#include "src/xgt_cnet/server.hpp"

namespace fieldproof {

class Plc : public EmulatedDevice {
 public:
  Plc(const Plc&) = delete;
  Plc& operator=(const Plc&) = delete;

  void receive(const Burst& burst) override;
  std::optional<Time> wake_at() const override;
  Bytes advance(Time now) override;

  Status set(std::string_view address, std::string_view hex) override;
  Result<std::string> get(std::string_view address, std::size_t digits) const override;
  /// power_cycle: registrations, counters and frames in progress are lost; memory and mode stay.
  Status act(std::string_view action) override;

 private:
  friend Result<std::unique_ptr<Plc>> make_plc(const PlcConfig& config);
  Plc(const PlcModel& model, const PlcConfig& config, std::vector<P2pBlock> blocks);

  const ServiceCounters& counters() const { return client_ ? client_->counters() : server_->counters(); }

  PlcMemory memory_;
  std::optional<XgtServer> server_;  // one of the two
  std::optional<XgtClient> client_;
};

/// In its power-on state. Errors name the model, or the parameter that is out of its range.
Result<std::unique_ptr<Plc>> make_plc(const PlcConfig& config);

}  // namespace fieldproof
