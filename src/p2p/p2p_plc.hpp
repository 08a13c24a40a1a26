// An emulated XGB PLC as P2P client: one P2P parameter, with a client a channel.
//
// A protocol makes its device of role client so (its P2pDriver is all that it adds):
//
//   make_p2p_plc(model, config, [](const plc::PortConfig& port) {
//     return std::make_unique<MyDriver>(port.gap());
//   });
//
// `line()` is the channel that `p2p.channel` names; the other one of a built-in port shares memory.
// Who drives it puts it on a line of its own; undriven, its blocks never fire.
#pragma once

#include <functional>
#include <initializer_list>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string_view>
#include <vector>

#include "src/p2p/client.hpp"
#include "src/p2p/network_client.hpp"
#include "src/plc/plc.hpp"
#include "src/plc/port_config.hpp"

namespace fieldproof::p2p {

/// The driver of one channel, in its power-on state.
using P2pDriverFactory = std::function<std::unique_ptr<P2pDriver>(const plc::PortConfig& port)>;

/// Puts the clients on their channels. `config` is `given.config` of a vector (vectors/README.md):
/// the basic parameters of a port, time_out (n of (n + 1) x 100 ms, 0-50), p2p, and `own_keys`,
/// which the caller reads itself. Both channels have the port's settings. Errors name the key, or
/// the block and its key.
Status add_p2p_clients(plc::Plc& plc, const nlohmann::json& config, const P2pDriverFactory& driver,
                       std::initializer_list<std::string_view> own_keys = {});

/// A PLC in its power-on state with these clients. Errors also name the model.
Result<std::unique_ptr<plc::Plc>> make_p2p_plc(
    std::string_view model, const nlohmann::json& config, const P2pDriverFactory& driver,
    std::initializer_list<std::string_view> own_keys = {});

/// The same as a device.
Result<std::unique_ptr<plc::EmulatedDevice>> make_p2p_device(
    std::string_view model, const nlohmann::json& config, const P2pDriverFactory& driver,
    std::initializer_list<std::string_view> own_keys = {});

/// Where partners listen. udp 0: the driver is fixed to TCP (FEnet EN table 7-3).
struct PartnerPorts {
  std::uint16_t tcp = 0, udp = 0;
};

/// What a channel of an Ethernet module may speak (FEnet EN table 7-3).
struct NetworkDriver {
  std::string_view protocol;  // "modbus-tcp"
  PartnerPorts ports;
  std::function<std::unique_ptr<P2pDriver>()> make;
};

/// The P2P channels of an Ethernet module (FEnet EN 7.3.2), up to three. `config`: mode, role,
/// station (the unit of a block that gives no station), connections (of the module's server, which
/// leave 4 less as many channels), p2p (parameters.hpp). `drivers`: the first is that of a channel
/// that names none. Errors name the key, or the block and its key.
Status add_network_clients(plc::Plc& plc, const nlohmann::json& config,
                           const std::vector<NetworkDriver>& drivers);

/// How many connections the P2P channels in `p2p` leave to the module's server (FEnet EN 7.3.2).
unsigned connections_beside(const nlohmann::json& p2p);

/// Is role client asked for?
bool is_p2p_client(const nlohmann::json& config);

}  // namespace fieldproof::p2p
