#include "src/p2p/p2p_plc.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "src/base/spelling.hpp"

namespace fieldproof::p2p {

namespace {
constexpr unsigned longest_time_out = 50;  // Cnet EN figure 4.3.1: (0-50)(*100ms)
constexpr unsigned most_connections = 4;   // of an Ethernet module (FEnet EN 7.3.2)
constexpr Duration network_time_out = 5s;  // decision: FEnet EN prints none

constexpr std::string_view whose = "the P2P client's configuration";

Error no_blocks() {
  return fail("cannot make a P2P client: there is no p2p; give its blocks, or role server");
}

/// The main channel, and those that have blocks.
std::vector<unsigned> channels_in_use(const P2pParameters& parameters) {
  std::vector<unsigned> channels{parameters.channel};
  for (const P2pBlock& block : parameters.blocks)
    if (!block.is_mail() && std::ranges::find(channels, block.channel) == channels.end())
      channels.push_back(block.channel);
  return channels;
}

/// The client of one channel.
Result<std::unique_ptr<P2pClient>> make_client(plc::PlcMemory& memory,
                                               const P2pParameters& parameters, unsigned channel,
                                               std::unique_ptr<P2pDriver> driver,
                                               const P2pClient::Timing& timing) {
  if (const Status status = check_p2p_driver(parameters, channel, *driver, memory.model()); !status)
    return status.error();
  return std::make_unique<P2pClient>(memory, parameters, channel, std::move(driver), timing,
                                     [&memory] { memory.written(); });
}
}  // namespace

Status add_p2p_clients(plc::Plc& plc, const nlohmann::json& config, const P2pDriverFactory& driver,
                       std::initializer_list<std::string_view> own_keys) {
  std::vector<std::string_view> keys = plc::port_keys(own_keys);
  keys.insert(keys.end(), {"p2p", "time_out"});
  if (const Status status = plc::known_keys(config, whose, keys); !status) return status;
  const plc::PlcModel& model = plc.memory().model();
  plc::PortConfig port;
  port.model = model.name;
  unsigned time_out = 1;
  plc::ConfigReader reader(config, std::string(whose));
  plc::read_port_config(reader, port);
  reader.whole("time_out", longest_time_out, time_out);
  if (reader.error()) return *reader.error();
  if (const auto right = plc::check_port_config(port); !right) return right.error();
  if (!config.contains("p2p")) return no_blocks();
  const Result<P2pParameters> parameters = parse_p2p_parameters(config["p2p"], model);
  if (!parameters) return parameters.error();

  write_p2p_registers(plc.memory(), *parameters);
  const P2pClient::Timing timing{100ms * (time_out + 1), port.reply_delay(),
                                 port.line.character_time()};
  for (const unsigned channel : channels_in_use(*parameters)) {
    auto client = make_client(plc.memory(), *parameters, channel, driver(port), timing);
    if (!client) return client.error();
    if (const Status added = plc.add(channel, std::move(*client)); !added) return added;
  }
  return ok();
}

Result<std::unique_ptr<plc::Plc>> make_p2p_plc(std::string_view model, const nlohmann::json& config,
                                               const P2pDriverFactory& driver,
                                               std::initializer_list<std::string_view> own_keys) {
  Result<std::unique_ptr<plc::Plc>> plc = plc::make_plc(model, config);
  if (!plc) return plc.error();
  if (const Status added = add_p2p_clients(**plc, config, driver, own_keys); !added)
    return added.error();
  return plc;
}

Result<std::unique_ptr<plc::EmulatedDevice>> make_p2p_device(
    std::string_view model, const nlohmann::json& config, const P2pDriverFactory& driver,
    std::initializer_list<std::string_view> own_keys) {
  Result<std::unique_ptr<plc::Plc>> plc = make_p2p_plc(model, config, driver, own_keys);
  if (!plc) return plc.error();
  return std::unique_ptr<plc::EmulatedDevice>(std::move(*plc));
}

namespace {
/// The server's connections, and the channels that are used, are no more than the module has.
Status check_channels(const P2pParameters& parameters, unsigned dedicated) {
  std::set<unsigned> channels;
  for (const P2pBlock& block : parameters.blocks)
    if (!block.is_mail()) channels.insert(block.channel);
  const std::size_t used = channels.size();
  if (used + dedicated <= most_connections) return ok();
  return fail(
      fmt::format("cannot read p2p: it uses {} channels, and connections is {}; together they are "
                  "at most {} (FEnet EN 7.3.2)",
                  used, dedicated, most_connections));
}

Result<const NetworkDriver*> driver_of(const P2pChannel& channel,
                                       const std::vector<NetworkDriver>& drivers) {
  if (channel.protocol.empty()) return &drivers.front();
  std::vector<std::string_view> names;
  for (const NetworkDriver& one : drivers) {
    if (one.protocol == channel.protocol) return &one;
    names.push_back(one.protocol);
  }
  return fail(fmt::format("cannot read p2p.channels: channel {} cannot speak '{}'; use one of {}{}",
                          channel.number, channel.protocol, fmt::join(names, ", "),
                          suggestion(channel.protocol, names)));
}

Result<NetworkPartner> partner_of(const P2pChannel& channel, const NetworkDriver& driver) {
  const bool datagrams = channel.transport == Transport::udp;
  if (datagrams && driver.ports.udp == 0)
    return fail(fmt::format(
        "cannot read p2p: transport of channel {} is udp, and {} is fixed to TCP (FEnet EN table "
        "7-3); leave transport out",
        channel.number, driver.protocol));
  const std::uint16_t usual = datagrams ? driver.ports.udp : driver.ports.tcp;
  return NetworkPartner{channel.partner,
                        channel.port != 0 ? static_cast<std::uint16_t>(channel.port) : usual,
                        channel.transport};
}

Status add_network_client(plc::Plc& plc, const P2pParameters& parameters, unsigned channel,
                          const std::vector<NetworkDriver>& drivers) {
  const P2pChannel settings = parameters.settings_of(channel);
  const Result<const NetworkDriver*> driver = driver_of(settings, drivers);
  if (!driver) return driver.error();
  const Result<NetworkPartner> partner = partner_of(settings, **driver);
  if (!partner) return partner.error();
  auto client =
      make_client(plc.memory(), parameters, channel, (*driver)->make(), {network_time_out});
  if (!client) return client.error();
  return plc.add(std::make_unique<NetworkClient>(std::move(*client), *partner, plc.own_links()));
}
}  // namespace

Status add_network_clients(plc::Plc& plc, const nlohmann::json& config,
                           const std::vector<NetworkDriver>& drivers) {
  const auto keys = plc::network_keys({"connections", "p2p"});
  if (const Status status = plc::known_keys(config, whose, keys); !status) return status;
  P2pRules rules = network_p2p_rules();
  plc::ConfigReader reader(config, std::string(whose));
  unsigned dedicated = 1;
  reader.whole("station", 255, rules.station);
  reader.whole("connections", most_connections, dedicated);
  if (reader.error()) return *reader.error();
  if (!config.contains("p2p")) return no_blocks();
  const plc::PlcModel& model = plc.memory().model();
  const Result<P2pParameters> parameters = parse_p2p_parameters(config["p2p"], model, rules);
  if (!parameters) return parameters.error();
  if (const Status fit = check_channels(*parameters, dedicated); !fit) return fit;

  write_p2p_registers(plc.memory(), *parameters);
  for (const unsigned channel : channels_in_use(*parameters))
    if (const Status added = add_network_client(plc, *parameters, channel, drivers); !added)
      return added;
  return ok();
}

unsigned connections_beside(const nlohmann::json& p2p) {
  std::set<nlohmann::json> channels;
  const nlohmann::json usual = p2p.value("channel", nlohmann::json(1));
  for (const nlohmann::json& block : p2p.value("blocks", nlohmann::json::array())) {
    const std::string function = block.value("function", "read");
    if (function != "esend" && function != "ereceive")
      channels.insert(block.value("channel", usual));
  }
  return most_connections - static_cast<unsigned>(std::min<std::size_t>(channels.size(), 3));
}

bool is_p2p_client(const nlohmann::json& config) {
  return config.is_object() && config.contains("role") && config["role"] == "client";
}

}  // namespace fieldproof::p2p
