#include "suites/modbus/tcp_broken/broken_server.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "src/modbus/bases.hpp"
#include "src/modbus/data_space.hpp"
#include "src/modbus/modbus_plc.hpp"
#include "src/xnet/plc.hpp"

namespace fieldproof::modbus_tcp_broken {

namespace {

constexpr unsigned least_length = 2, most_length = 260;

/// A length that no frame has takes all that came with it.
std::optional<std::size_t> first_frame(ByteView stream) {
  if (stream.size() < unit_at) return std::nullopt;
  const unsigned length = stream[length_at] * 256u + stream[length_at + 1];
  if (length < least_length || length > most_length) return stream.size();
  return stream.size() < unit_at + length ? std::nullopt : std::optional(unit_at + length);
}

Result<std::unique_ptr<modbus::DataSpace>> data_of(plc::PlcMemory& memory,
                                                   const nlohmann::json& config) {
  modbus::ModbusBases bases = modbus::default_modbus_bases(memory.model());
  for (std::size_t i = 0; i < bases.size(); ++i)
    bases[i] = config.value(std::string(modbus::modbus_base_names[i]) + "_base", bases[i]);
  const Result<modbus::ModbusTables> tables = modbus::place_modbus_tables(memory.model(), bases);
  if (!tables) return tables.error();
  return std::unique_ptr<modbus::DataSpace>(
      std::make_unique<modbus::PlcDataSpace>(*tables, memory));
}

}  // namespace

Result<std::unique_ptr<plc::EmulatedDevice>> make_broken_server(const Behaviour& behaviour,
                                                                std::string_view model,
                                                                const nlohmann::json& config) {
  if (model == xnet::xd) {  // its settings are its own
    auto xinje = xnet::make_xinje_plc(modbus::ModbusMode::tcp, config);
    if (!xinje) return xinje.error();
    return std::unique_ptr<plc::EmulatedDevice>(
        std::make_unique<broken::NetworkServer>(behaviour, std::move(*xinje), first_frame));
  }
  Result<std::unique_ptr<plc::Plc>> good = plc::make_plc(model, config);
  if (!good) return good.error();
  modbus::TcpServerConfig settings = modbus::fenet_server();
  if (const Status read = modbus::read_tcp_config(config, settings); !read) return read.error();
  if (behaviour.settings) behaviour.settings(settings);
  Result<std::unique_ptr<modbus::DataSpace>> data = data_of((*good)->memory(), config);
  if (!data) return data.error();
  const Status added =
      (*good)->add(std::make_unique<modbus::ModbusTcpServer>(std::move(*data), settings));
  if (!added) return added.error();
  return std::unique_ptr<plc::EmulatedDevice>(
      std::make_unique<broken::NetworkServer>(behaviour, std::move(*good), first_frame));
}

}  // namespace fieldproof::modbus_tcp_broken
