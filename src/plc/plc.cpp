#include "src/plc/plc.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "src/plc/port_config.hpp"

namespace fieldproof::plc {

namespace {
constexpr std::size_t most_hosts = 16;

Result<std::vector<std::string>> read_host_table(const nlohmann::json& table) {
  const auto wrong = [](const std::string& what) {
    return fail("cannot read the PLC's configuration: host_table " + what);
  };
  if (!table.is_array()) return wrong("is no array of IPv4 addresses, such as [\"192.0.2.1\"]");
  if (table.size() > most_hosts)
    return wrong(fmt::format("has {} addresses; give at most {}", table.size(), most_hosts));
  std::vector<std::string> addresses;
  for (const nlohmann::json& one : table) {
    if (!one.is_string() || !is_ipv4(one.get_ref<const std::string&>()))
      return wrong(
          fmt::format("has {}, which is no IPv4 address such as \"192.0.2.1\"", one.dump()));
    addresses.push_back(one);
  }
  return addresses;
}
}  // namespace

Result<std::unique_ptr<Plc>> make_plc(std::string_view model, const nlohmann::json& config) {
  const Result<const PlcModel*> known = known_plc_model(model);
  if (!known) return known.error();
  bool run = true;
  ConfigReader reader(config, "the PLC's configuration");
  reader.either("mode", "run", "stop", run);
  if (reader.error()) return *reader.error();
  auto plc = std::make_unique<Plc>(**known, run);
  if (config.is_object() && config.contains("host_table")) {
    Result<std::vector<std::string>> addresses = read_host_table(config["host_table"]);
    if (!addresses) return addresses.error();
    plc->allow_only(std::move(*addresses));
  }
  return plc;
}

}  // namespace fieldproof::plc
