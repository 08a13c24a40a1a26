#include "src/xgt_cnet/plc.hpp"

#include "src/plc/device_action.hpp"

namespace fieldproof {

Result<std::unique_ptr<Plc>> make_plc(const PortConfig& config) {
  const Result<const PlcModel*> known = check_port_config(config);
  if (!known) return known.error();
  return std::unique_ptr<Plc>(new Plc(**known, config));
}

Result<std::string> Plc::get(std::string_view address, std::size_t digits) const {
  if (address.starts_with('@')) return get_counter(server_.counters(), address, digits);
  return get_by_name(memory_, address, digits);
}

Status Plc::act(std::string_view action) {
  const Result<DeviceAction> known = parse_device_action(action);
  if (!known) return known.error();
  if (*known == DeviceAction::power_cycle) server_.power_cycle();
  return ok();
}

}  // namespace fieldproof
