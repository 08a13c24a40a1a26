#include "src/xgt_cnet/plc.hpp"

#include "src/plc/device_action.hpp"

namespace fieldproof::xgt_cnet {

Result<std::unique_ptr<Plc>> make_plc(const plc::PortConfig& config) {
  const Result<const plc::PlcModel*> known = plc::check_port_config(config);
  if (!known) return known.error();
  return std::unique_ptr<Plc>(new Plc(**known, config));
}

Result<std::string> Plc::get(std::string_view address, std::size_t digits) const {
  if (address.starts_with('@')) return plc::get_counter(server_.counters(), address, digits);
  return plc::get_by_name(memory_, address, digits);
}

Status Plc::act(std::string_view action) {
  const Result<plc::DeviceAction> known = plc::parse_device_action(action);
  if (!known) return known.error();
  if (*known == plc::DeviceAction::power_cycle) server_.power_cycle();
  return ok();
}

}  // namespace fieldproof::xgt_cnet
