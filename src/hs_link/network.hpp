// Stations that exchange blocks over the high-speed link, in one device: the first is the one that
// a case is about. Nothing of it is on a wire.
#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string_view>
#include <utility>
#include <vector>

#include "src/hs_link/station.hpp"
#include "src/plc/emulated_device.hpp"

namespace fieldproof::hs_link {

class HsNetwork : public plc::SerialDevice {
 public:
  /// At least one station.
  explicit HsNetwork(std::vector<std::unique_ptr<Station>> stations);

  /// No byte means anything to it.
  void receive(const Burst&) override {}
  std::optional<Time> wake_at() const override;
  Bytes advance(Time now) override;

  /// "%MW100" is of the first station, "2:%MW100" of station 2, and so are "@sent" and "@received",
  /// its packets. Errors name the address.
  Status set(std::string_view address, std::string_view hex) override;
  Result<std::string> get(std::string_view address, std::size_t digits) const override;
  /// "run", "stop", "power_cycle", "error on", "error off", "link on", "link off" of the first;
  /// "station 2 run" and so on of another, also "on" and "off": its power.
  Status act(std::string_view action) override;

 private:
  /// The station that an address or an action begins with, which is taken off; nullptr: there is
  /// none of that number.
  Station* named(std::string_view& text, std::string_view head, char tail) const;
  void exchange();
  void deliver(const std::vector<std::pair<Station*, Broadcast>>& sent);
  void show_flags();

  std::vector<std::unique_ptr<Station>> stations_;
  Time now_{};
};

/// Of given.config (vectors/README.md): station, mode, hs_link, stations. Errors name the key.
Result<std::unique_ptr<plc::EmulatedDevice>> make_hs_network(std::string_view model,
                                                             const nlohmann::json& config);

}  // namespace fieldproof::hs_link
