#include "suites/services/services.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <vector>

#include "src/base/spelling.hpp"
#include "src/modbus/modbus_plc.hpp"
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
                           Kind{"modbus-tcp", add_modbus<modbus::ModbusMode::tcp>},
                           Kind{"xgt-fenet", xgt_fenet::add_server}};

Status add_service(plc::Plc& plc, const std::string& name, const json& config) {
  const auto kind = std::ranges::find(kinds, name, &Kind::name);
  if (kind != kinds.end()) return kind->add(plc, config);
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
      if (const Status added = add_service(**plc, name, of_service); !added)
        return fail(fmt::format("cannot add service '{}': {}", name, added.error().message));
  }
  return std::unique_ptr<plc::EmulatedDevice>(std::move(*plc));
}

}  // namespace fieldproof::services
