#include "src/modbus/modbus_plc.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "src/modbus/bases.hpp"
#include "src/modbus/server.hpp"
#include "src/plc/port_config.hpp"

namespace fieldproof::modbus {

namespace {
constexpr std::string_view whose = "the Modbus server's configuration";

std::vector<std::string_view> known_keys_of(ModbusMode mode) {
  if (mode == ModbusMode::tcp)
    return plc::network_keys({"bit_read_base", "bit_write_base", "connections", "waiting_time",
                              "word_read_base", "word_write_base"});
  return plc::port_keys({"bit_read_base", "bit_write_base", "word_read_base", "word_write_base"});
}

Result<std::unique_ptr<DataSpace>> make_data_space(plc::PlcMemory& memory,
                                                   const nlohmann::json& config) {
  ModbusBases bases = default_modbus_bases(memory.model());
  plc::ConfigReader reader(config, std::string(whose));
  for (std::size_t i = 0; i < bases.size(); ++i)
    reader.text((std::string(modbus_base_names[i]) + "_base").c_str(), bases[i]);
  if (reader.error()) return *reader.error();
  const Result<ModbusTables> tables = place_modbus_tables(memory.model(), bases);
  if (!tables) return tables.error();
  return std::unique_ptr<DataSpace>(std::make_unique<PlcDataSpace>(*tables, memory));
}
}  // namespace

TcpServerConfig fenet_server() { return {.waiting_time = 100s}; }

Status read_tcp_config(const nlohmann::json& config, TcpServerConfig& to) {
  return plc::read_dedicated_config(config, whose, to);
}

Status add_modbus_server(plc::Plc& plc, ModbusMode mode, unsigned channel,
                         const nlohmann::json& config) {
  if (config.is_object() && config.contains("role") && config["role"] == "client")
    return fail("cannot make a Modbus server of role client; leave role out, or give server");
  if (const Status status = plc::known_keys(config, whose, known_keys_of(mode)); !status)
    return status;
  plc::PortConfig port;
  TcpServerConfig tcp = fenet_server();
  plc::ConfigReader reader(config, std::string(whose));
  port.model = plc.memory().model().name;
  plc::read_port_config(reader, port);
  if (reader.error()) return *reader.error();
  if (const auto right = plc::check_port_config(port); !right) return right.error();
  if (const Status read = read_tcp_config(config, tcp); !read) return read;
  Result<std::unique_ptr<DataSpace>> data = make_data_space(plc.memory(), config);
  if (!data) return data.error();
  if (mode != ModbusMode::tcp)
    return plc.add(channel, std::make_unique<ModbusServer>(mode, std::move(*data), port));
  return plc.add(std::make_unique<ModbusTcpServer>(std::move(*data), tcp));
}

Result<std::unique_ptr<plc::EmulatedDevice>> make_modbus_plc(ModbusMode mode,
                                                             std::string_view model,
                                                             const nlohmann::json& config) {
  Result<std::unique_ptr<plc::Plc>> plc = plc::make_plc(model, config);
  if (!plc) return plc.error();
  if (const Status added = add_modbus_server(**plc, mode, 1, config); !added) return added.error();
  return std::unique_ptr<plc::EmulatedDevice>(std::move(*plc));
}

}  // namespace fieldproof::modbus
