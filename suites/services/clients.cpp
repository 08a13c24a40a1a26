#include "suites/services/clients.hpp"

#include <algorithm>
#include <utility>

#include "src/modbus/p2p_driver.hpp"
#include "src/modbus/tcp_server.hpp"
#include "src/xgt_fenet/p2p_driver.hpp"
#include "src/xgt_fenet/server.hpp"

namespace fieldproof::services {

std::vector<p2p::NetworkDriver> client_drivers(std::string_view first) {
  std::vector<p2p::NetworkDriver> drivers{
      {"xgt-fenet",
       {.tcp = xgt_fenet::tcp_port, .udp = xgt_fenet::udp_port},
       [] { return std::make_unique<xgt_fenet::FenetP2pDriver>(); }},
      {"modbus-tcp", {.tcp = modbus::tcp_port}, [] {
         return modbus::make_modbus_p2p_driver(modbus::ModbusMode::tcp);
       }}};
  std::ranges::stable_partition(drivers, [&](const auto& one) { return one.protocol == first; });
  return drivers;
}

std::vector<p2p::NetworkDriver> client_drivers(p2p::NetworkDriver own) {
  std::vector<p2p::NetworkDriver> drivers = client_drivers();
  drivers.insert(drivers.begin(), std::move(own));
  return drivers;
}

}  // namespace fieldproof::services
