#include "src/xnet/plc.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "src/modbus/data_space.hpp"
#include "src/modbus/modbus_plc.hpp"
#include "src/modbus/server.hpp"
#include "src/plc/port_config.hpp"

namespace fieldproof::xnet {

namespace {
using modbus::ModbusBase;
using modbus::ModbusMode;

constexpr std::string_view configured = "the XINJE PLC's configuration";

class XinjeDataSpace : public modbus::DataSpace {
 public:
  XinjeDataSpace(Memory& memory, std::function<void()> written)
      : memory_(memory), written_(std::move(written)) {}

  bool covers(ModbusBase table, std::uint32_t address, std::uint32_t count, bool) const override {
    const std::optional<Component> first = at(table, address);
    return first && count <= std::min(first->area->shown - first->number,
                                      room_from(*first, memory_.series()));
  }
  unsigned read(ModbusBase table, std::uint32_t address) const override {
    return memory_.read(*at(table, address));
  }
  void write(ModbusBase table, std::uint32_t address, unsigned value) override {
    memory_.write(*at(table, address), value);
  }
  void written() override { written_(); }

 private:
  static std::optional<Component> at(ModbusBase table, std::uint32_t address) {
    return component_at(table == ModbusBase::bit_read || table == ModbusBase::bit_write, address);
  }

  Memory& memory_;
  std::function<void()> written_;
};
}  // namespace

Status XinjePlc::set(std::string_view address, std::string_view hex) {
  const Status status = memory_.set(address, hex);
  if (status) scan();
  return status;
}

Result<std::string> XinjePlc::get(std::string_view address, std::size_t digits) const {
  if (address.starts_with('@')) return get_of_service(address, digits);
  return memory_.get(address, digits);
}

Status XinjePlc::serve(ModbusMode mode, const nlohmann::json& config) {
  return add_modbus_server(
      *this, memory_, [this] { scan(); }, mode, 1, config);
}

Status add_modbus_server(plc::Controller& plc, Memory& memory, std::function<void()> written,
                         ModbusMode mode, unsigned channel, const nlohmann::json& config) {
  if (config.is_object() && config.value("role", "server") != "server")
    return fail("cannot make a XINJE PLC of role client; it is no Modbus TCP client (X-NET 3-4-2)");
  const bool network = mode == ModbusMode::tcp;
  const auto keys = network ? plc::network_keys({"connections", "waiting_time"}) : plc::port_keys();
  if (const Status known = plc::known_keys(config, configured, keys); !known) return known;
  plc::PortConfig port;
  plc::ConfigReader reader(config, std::string(configured));
  plc::read_port_config(reader, port);
  if (reader.error()) return *reader.error();
  if (const auto right = plc::check_port_config(port); !right) return right.error();
  auto data = std::make_unique<XinjeDataSpace>(memory, std::move(written));
  if (!network)
    return plc.add(channel, std::make_unique<modbus::ModbusServer>(mode, std::move(data), port));
  modbus::TcpServerConfig tcp;
  if (const Status read = modbus::read_tcp_config(config, tcp); !read) return read;
  return plc.add(std::make_unique<modbus::ModbusTcpServer>(std::move(data), tcp));
}

Result<std::unique_ptr<plc::EmulatedDevice>> make_xinje_plc(ModbusMode mode,
                                                            const nlohmann::json& config) {
  bool run = true;
  plc::ConfigReader reader(config, std::string(configured));
  reader.either("mode", "run", "stop", run);
  if (reader.error()) return *reader.error();
  auto plc = std::make_unique<XinjePlc>(run);
  if (const Status added = plc->serve(mode, config); !added) return added.error();
  return std::unique_ptr<plc::EmulatedDevice>(std::move(plc));
}

}  // namespace fieldproof::xnet
