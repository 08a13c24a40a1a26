#include "suites/services/services.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <vector>

#include "src/base/spelling.hpp"
#include "src/modbus/modbus_plc.hpp"
#include "src/p2p/p2p_plc.hpp"
#include "src/xgt_cnet/plc.hpp"
#include "src/xgt_cnet/plc_config.hpp"
#include "src/xgt_fenet/plc.hpp"

namespace fieldproof::services {

namespace {

using nlohmann::json;

constexpr const char* key = "services";
constexpr unsigned second_channel = 2;

struct Kind {
  std::string_view name;
  Status (*add)(plc::Plc& plc, const json& config);
  bool network = false;
};

Status add_xgt_cnet(plc::Plc& plc, const json& config) {
  const Result<plc::PortConfig> port =
      xgt_cnet::parse_plc_config(plc.memory().model().name, config);
  if (!port) return port.error();
  return xgt_cnet::add_server(plc, second_channel, *port);
}

template <modbus::ModbusMode mode>
Status add_modbus(plc::Plc& plc, const json& config) {
  return modbus::add_modbus_server(plc, mode, second_channel, config);
}

constexpr std::array kinds{Kind{"xgt-cnet", add_xgt_cnet},
                           Kind{"modbus-rtu", add_modbus<modbus::ModbusMode::rtu>},
                           Kind{"modbus-ascii", add_modbus<modbus::ModbusMode::ascii>},
                           Kind{"modbus-tcp", add_modbus<modbus::ModbusMode::tcp>, true},
                           Kind{"xgt-fenet", xgt_fenet::add_server, true}};

/// A server beside P2P channels has the connections that they leave, or less.
Result<json> beside_channels(const json& main, json config) {
  constexpr const char* number = "connections";
  if (!p2p::is_p2p_client(main) || !main.contains("p2p") || !config.is_object()) return config;
  const unsigned left = p2p::connections_beside(main["p2p"]);
  const auto own = config.find(number);
  if (own == config.end())
    config[number] = left;
  else if (own->is_number_integer() && own->get<std::int64_t>() > left)
    return fail(fmt::format(
        "connections is {}, and the P2P channels leave {} of the module's 4 (FEnet EN 7.3.2)",
        own->dump(), left));
  return config;
}

Status add_service(plc::Plc& plc, const std::string& name, const json& main, const json& config) {
  const auto kind = std::ranges::find(kinds, name, &Kind::name);
  if (kind != kinds.end() && !kind->network) return kind->add(plc, config);
  if (kind != kinds.end()) {
    const Result<json> beside = beside_channels(main, config);
    return beside ? kind->add(plc, *beside) : Status(beside.error());
  }
  std::vector<std::string_view> names;
  for (const Kind& one : kinds) names.push_back(one.name);
  return fail(fmt::format("there is no such service{}", suggestion(name, names)));
}

}  // namespace

bool wants_services(const json& config) { return config.is_object() && config.contains(key); }

Result<std::unique_ptr<plc::EmulatedDevice>> make_plc(std::string_view model, const json& config,
                                                      const AddMain& add) {
  Result<std::unique_ptr<plc::Plc>> plc = plc::make_plc(model, config);
  if (!plc) return plc.error();
  json own = config;
  if (own.is_object()) own.erase(key);
  if (const Status added = add(**plc, own); !added) return added.error();
  if (wants_services(config)) {
    const json& further = config[key];
    if (!further.is_object())
      return fail(fmt::format("cannot read services: {} is no object of protocol and configuration",
                              further.dump()));
    for (const auto& [name, of_service] : further.items())
      if (const Status added = add_service(**plc, name, own, of_service); !added)
        return fail(fmt::format("cannot add service '{}': {}", name, added.error().message));
  }
  return std::unique_ptr<plc::EmulatedDevice>(std::move(*plc));
}

}  // namespace fieldproof::services
