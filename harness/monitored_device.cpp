#include "harness/monitored_device.hpp"

#include <nlohmann/json.hpp>

#include "src/plc/port_config.hpp"

namespace fieldproof::harness {

Result<std::unique_ptr<plc::EmulatedDevice>> make_monitored_device(
    const Protocol& protocol, std::string_view model, nlohmann::json config,
    const plc::FrameMonitor::Record& record) {
  if (!config.is_object() || (!record && !config.contains("monitor")))
    return protocol.make_device(model, config);
  bool monitored = record != nullptr;
  plc::PortConfig port;
  plc::ConfigReader reader(config, "the emulated device's configuration");
  if (!monitored) reader.boolean("monitor", monitored);
  plc::read_port_config(reader, port);
  if (reader.error()) return *reader.error();
  config.erase("monitor");
  Result<std::unique_ptr<plc::EmulatedDevice>> device = protocol.make_device(model, config);
  if (!device || !monitored) return device;
  const Protocol& own = protocol.of_model(model);
  const bool client = port.role == plc::PortConfig::Role::client;
  plc::MonitorRules rules{
      [&own](ByteView bytes) { return own.frame_length(bytes); },
      [&own, client](ByteView frame, bool sent) { return own.monitor_result(frame, client, sent); },
      port.gap()};
  return std::unique_ptr<plc::EmulatedDevice>(
      std::make_unique<plc::FrameMonitor>(std::move(*device), std::move(rules), record));
}

}  // namespace fieldproof::harness
