#include "suites/p2p/broken/drivers.hpp"

#include <nlohmann/json.hpp>

#include "src/ls_bus/p2p_driver.hpp"
#include "src/modbus/p2p_driver.hpp"
#include "src/user_frames/p2p_driver.hpp"
#include "src/xgt_cnet/p2p_driver.hpp"
#include "suites/user_frames/definition_files.hpp"

namespace fieldproof::p2p_broken {

Result<std::unique_ptr<p2p::P2pDriver>> make_driver(std::string_view protocol,
                                                    const plc::PortConfig& port,
                                                    const nlohmann::json& config,
                                                    std::string_view model,
                                                    const p2p::P2pParameters& parameters) {
  if (protocol == "xgt-cnet")
    return std::unique_ptr<p2p::P2pDriver>(std::make_unique<xgt_cnet::XgtP2pDriver>(port.gap()));
  if (protocol == "modbus-rtu")
    return modbus::make_modbus_p2p_driver(modbus::ModbusMode::rtu, port.gap());
  if (protocol == "modbus-ascii")
    return modbus::make_modbus_p2p_driver(modbus::ModbusMode::ascii, port.gap());
  if (protocol == "ls-bus") {
    const bool count_first = config.value("write_order", "") == "count_first";
    return ls_bus::make_ls_bus_p2p_driver(
        count_first ? ls_bus::LsWriteOrder::count_first : ls_bus::LsWriteOrder::address_first,
        port.gap());
  }
  const Result<user_frames_suite::NamedDefinition> frames = user_frames_suite::load_definition(
      config.value("definition", std::string(model)), user_frames_suite::definitions_folder());
  if (!frames) return frames.error();
  return user_frames::make_user_frame_p2p_driver(frames->definition, parameters.blocks, port.gap());
}

}  // namespace fieldproof::p2p_broken
