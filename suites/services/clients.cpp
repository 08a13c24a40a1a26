#include "suites/services/clients.hpp"

#include <utility>

#include "src/modbus/p2p_driver.hpp"
#include "src/modbus/tcp_server.hpp"
#include "src/xgt_fenet/p2p_driver.hpp"
#include "src/xgt_fenet/server.hpp"

namespace fieldproof::services {

std::vector<p2p::NetworkDriver> client_drivers(p2p::NetworkDriver own) {
  std::vector<p2p::NetworkDriver> drivers{std::move(own)};
  const auto add = [&](p2p::NetworkDriver driver) {
    if (driver.protocol != drivers.front().protocol) drivers.push_back(std::move(driver));
  };
  add({"xgt-fenet", {.tcp = xgt_fenet::tcp_port, .udp = xgt_fenet::udp_port}, [] {
         return std::make_unique<xgt_fenet::FenetP2pDriver>();
       }});
  add({"modbus-tcp", {.tcp = modbus::tcp_port}, [] {
         return modbus::make_modbus_p2p_driver(modbus::ModbusMode::tcp);
       }});
  return drivers;
}

}  // namespace fieldproof::services
