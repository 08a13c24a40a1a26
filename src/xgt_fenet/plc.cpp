#include "src/xgt_fenet/plc.hpp"

#include <fmt/format.h>

#include <array>
#include <nlohmann/json.hpp>

#include "src/base/spelling.hpp"
#include "src/plc/port_config.hpp"

namespace fieldproof::xgt_fenet {

namespace {

constexpr std::string_view whose = "the XGT FEnet server's configuration";
constexpr std::array<std::string_view, 3> policies{"ignore", "zero_or_valid", "strict"};

Result<CheckPolicy> read_policy(const std::string& name) {
  for (std::size_t i = 0; i < policies.size(); ++i)
    if (policies[i] == name) return static_cast<CheckPolicy>(i);
  return fail(
      fmt::format("cannot read {}: header_check is '{}'; give ignore, zero_or_valid or "
                  "strict{}",
                  whose, name, suggestion(name, policies)));
}

}  // namespace

Result<ServerConfig> read_server_config(const nlohmann::json& config) {
  const auto keys =
      plc::network_keys({"base", "connections", "error", "header_check", "slot", "waiting_time"});
  if (const Status status = plc::known_keys(config, whose, keys); !status) return status.error();
  if (config.contains("role") && config["role"] == "client")
    return fail("cannot make an XGT FEnet server of role client; leave role out, or give server");
  ServerConfig result;
  plc::ConfigReader reader(config, std::string(whose));
  std::string policy(policies.front());
  bool run = true;
  unsigned station = 0;  // of no meaning here
  reader.whole("station", 255, station);
  reader.either("mode", "run", "stop", run);
  reader.whole("base", 15, result.base);
  reader.whole("slot", 15, result.slot, 1);  // 0 is the built-in Cnet (7.1.2)
  reader.boolean("error", result.cpu_error);
  reader.text("header_check", policy);
  if (reader.error()) return *reader.error();
  const Result<CheckPolicy> check = read_policy(policy);
  if (!check) return check.error();
  result.check = *check;
  if (const Status read = plc::read_dedicated_config(config, whose, result.dedicated); !read)
    return read.error();
  return result;
}

Status add_server(plc::Plc& plc, const nlohmann::json& config) {
  const Result<ServerConfig> read = read_server_config(config);
  if (!read) return read.error();
  return plc.add(std::make_unique<FenetServer>(plc.memory(), *read));
}

Result<std::unique_ptr<plc::EmulatedDevice>> make_plc(std::string_view model,
                                                      const nlohmann::json& config) {
  Result<std::unique_ptr<plc::Plc>> plc = plc::make_plc(model, config);
  if (!plc) return plc.error();
  if (const Status added = add_server(**plc, config); !added) return added.error();
  return std::unique_ptr<plc::EmulatedDevice>(std::move(*plc));
}

}  // namespace fieldproof::xgt_fenet
