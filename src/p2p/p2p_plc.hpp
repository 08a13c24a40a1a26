// An emulated XGB PLC whose channels are P2P clients: one model's memory, one P2P parameter, a
// client a channel.
//
// A protocol makes its device of role client so (its P2pDriver is all that it adds):
//
//   make_p2p_plc(model, config, [](const PortConfig& port) { return
//   std::make_unique<MyDriver>(port.gap()); });
//
// As a Device it is the channel that `p2p.channel` names; `channel(2)` is the other one of a
// built-in port, which shares memory. Who drives it puts it on a line of its own; undriven, its
// blocks never fire.
#pragma once

#include <array>
#include <functional>
#include <initializer_list>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string_view>

#include "src/p2p/client.hpp"
#include "src/plc/emulated_device.hpp"
#include "src/plc/port_config.hpp"

namespace fieldproof::p2p {

/// The driver of one channel, in its power-on state.
using P2pDriverFactory = std::function<std::unique_ptr<P2pDriver>(const plc::PortConfig& port)>;

class P2pPlc : public plc::EmulatedDevice {
 public:
  P2pPlc(const P2pPlc&) = delete;
  P2pPlc& operator=(const P2pPlc&) = delete;

  void receive(const Burst& burst) override { line_->receive(burst); }
  std::optional<Time> wake_at() const override { return line_->wake_at(); }
  Bytes advance(Time now) override { return line_->advance(now); }

  Status set(std::string_view address, std::string_view hex) override;
  /// The counters are those of the channel on the line.
  Result<std::string> get(std::string_view address, std::size_t digits) const override;
  /// Also "link on" and "link off". power_cycle: counters, clocks and what is under way are lost;
  /// memory, mode and link stay.
  Status act(std::string_view action) override;

  /// 1 or 2.
  P2pClient& channel(unsigned number) { return *channels_.at(number - 1); }
  /// For another service of the same PLC, such as a server on another channel. Who writes calls
  /// `scan` after it.
  plc::PlcMemory& memory() { return memory_; }
  void scan();

 private:
  friend Result<std::unique_ptr<P2pPlc>> make_p2p_plc(std::string_view, const nlohmann::json&,
                                                      const P2pDriverFactory&,
                                                      std::initializer_list<std::string_view>);
  P2pPlc(const plc::PlcModel& model, const P2pParameters& parameters, bool run);

  void update_mode();

  plc::PlcMemory memory_;
  bool run_, link_;
  std::array<std::unique_ptr<P2pClient>, 2> channels_;
  P2pClient* line_ = nullptr;
};

/// In its power-on state. `config` is `given.config` of a vector (vectors/README.md): the basic
/// parameters of a port, time_out (n of (n + 1) x 100 ms, 0-50), p2p, and `own_keys`, which the
/// caller reads itself. Both channels have the port's settings. Errors name the model, the key, or
/// the block and its key.
Result<std::unique_ptr<P2pPlc>> make_p2p_plc(std::string_view model, const nlohmann::json& config,
                                             const P2pDriverFactory& driver,
                                             std::initializer_list<std::string_view> own_keys = {});

/// The same as a device.
Result<std::unique_ptr<plc::EmulatedDevice>> make_p2p_device(
    std::string_view model, const nlohmann::json& config, const P2pDriverFactory& driver,
    std::initializer_list<std::string_view> own_keys = {});

/// Is role client asked for?
bool is_p2p_client(const nlohmann::json& config);

}  // namespace fieldproof::p2p
