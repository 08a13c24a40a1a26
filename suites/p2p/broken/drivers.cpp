#include "suites/p2p/broken/drivers.hpp"

#include <nlohmann/json.hpp>

#include "src/ls_bus/p2p_driver.hpp"
#include "src/modbus/p2p_driver.hpp"
#include "src/user_frames/p2p_driver.hpp"
#include "src/xgt_cnet/p2p_driver.hpp"
#include "suites/user_frames/definition_files.hpp"

namespace fieldproof::p2p {

Result<std::unique_ptr<P2pDriver>> make_driver(std::string_view protocol, const PortConfig& port,
                                               const nlohmann::json& config, std::string_view model,
                                               const P2pParameters& parameters) {
  if (protocol == "xgt-cnet")
    return std::unique_ptr<P2pDriver>(std::make_unique<XgtP2pDriver>(port.gap()));
  if (protocol == "modbus-rtu") return make_modbus_p2p_driver(ModbusMode::rtu, port.gap());
  if (protocol == "modbus-ascii") return make_modbus_p2p_driver(ModbusMode::ascii, port.gap());
  if (protocol == "ls-bus") {
    const bool count_first = config.value("write_order", "") == "count_first";
    return make_ls_bus_p2p_driver(
        count_first ? LsWriteOrder::count_first : LsWriteOrder::address_first, port.gap());
  }
  const Result<user_frames::NamedDefinition> frames = user_frames::load_definition(
      config.value("definition", std::string(model)), user_frames::definitions_folder());
  if (!frames) return frames.error();
  return make_user_frame_p2p_driver(frames->definition, parameters.blocks, port.gap());
}

}  // namespace fieldproof::p2p
