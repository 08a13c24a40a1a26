#include "src/xgt_cnet/plc_config.hpp"

#include <nlohmann/json.hpp>

namespace fieldproof::xgt_cnet {

Result<plc::PortConfig> parse_plc_config(std::string_view model, const nlohmann::json& config) {
  constexpr std::string_view what = "the PLC's configuration";
  if (config.is_object() && config.contains("p2p"))
    return fail("cannot make a PLC: a server has no p2p; remove it, or give role client");
  if (const Status status = plc::known_keys(config, what, plc::port_keys()); !status)
    return status.error();
  plc::PortConfig plc;
  plc.model = model;
  plc::ConfigReader reader(config, std::string(what));
  plc::read_port_config(reader, plc);
  if (reader.error()) return *reader.error();
  return plc;
}

}  // namespace fieldproof::xgt_cnet
