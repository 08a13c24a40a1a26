// What XINJEConfig sets: the ports of a PLC on X-NET and its route table, and what is wrong with
// it (X-NET 1-1-2, 1-1-3, 1-4, 3-1-2).
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "src/base/result.hpp"
#include "src/base/time.hpp"
#include "src/xnet/areas.hpp"
#include "src/xnet/memory.hpp"
#include "src/xnet_motion/servo.hpp"

namespace fieldproof::xnet {

struct Model {
  std::string_view name;
  Series series = Series::xd5;
  unsigned instructions = 10;  // at the same time (1-4, note 1)
  std::uint32_t d = 70000;     // registers D (1-3, note 3)
  bool ethernet = false, motion = false;
  unsigned first_port = 0, last_port = 5;  // serial (1-1-2: XG and XL have COM1 and COM2)
};
const std::vector<Model>& models();
const Model* find_model(std::string_view name);
/// Of a PLC of it that nobody has written to.
const Memory& blank_memory(const Model& model);
/// What is wrong with the text of an instruction, or of an action of a servo, for a PLC of `model`.
Status check_instruction(std::string_view text, const Model& model);
/// Where its motion bus is: the BD board, or port 2 of XG1 (2-1-2).
unsigned motion_port(const Model& model);

constexpr unsigned last_station = 32, ethernet_port = 9, words_at_once = 125, bits_at_once = 2000;

/// The protocol of a net: by who is on it (1-4 step 2).
enum class NetType { tbn, omms, ppf, ethernet };

struct Port {
  unsigned number = 2;
  NetType type = NetType::tbn;
  std::uint16_t net = 1;
  std::uint16_t station = 1;  // Ethernet: the last two bytes of the address
  unsigned baud = 1'000'000;  // bit/s
  Duration cycle{10ms};       // in which each station has the token once
  unsigned max_station = last_station;
};

/// As SD1905 to SD1910 show them (3-6).
struct Ethernet {
  std::uint32_t address = 0, mask = 0xFFFFFF00, gateway = 0;
};

struct Route {
  std::uint16_t net = 1;
  unsigned port = 2;
  std::uint16_t gateway = 0;  // the station that forwards; 0: the net is that of the port
};

/// An instruction in the program of a PLC, and the relay that is its condition.
struct Rung {
  Component relay;
  std::string instruction;  // as XnetNetwork::act takes it
  bool level = false;       // executed as long as the relay is on ("hold ..."), not at its edge
};

/// One PLC on the nets.
struct StationConfig {
  std::string name = "A";  // in vectors: "A", "B"
  const Model* model = nullptr;
  std::vector<Port> ports;
  std::vector<Route> routes;
  std::vector<Servo> servos;  // on its motion bus
  unsigned slaves = 10;       // SFD2991
  Ethernet ethernet;
  bool run = true;
  std::vector<Rung> program;

  const Port* port(unsigned number) const;
  const Route* route(std::uint32_t net) const;
};

/// The first two bytes of an address, and the last two (3-3-1): "192.168.6.60" is net 49320,
/// station 1596. Nothing where it is no IPv4 address.
struct NetAndStation {
  std::uint16_t net = 0, station = 0;
};
std::optional<NetAndStation> from_ip(std::string_view address);

/// `config` is one object of given.config (vectors/README.md). Errors name the key. A port without
/// a route gets the one that XINJEConfig shows, with gateway 0.
Result<StationConfig> read_station(const nlohmann::json& config, std::string name);

/// How far a TBN_RS485 cable reaches at a speed, in metres (1-1-2); nothing beyond 3 Mbit/s.
/// Between the rows the next faster one holds.
std::optional<unsigned> longest_cable(unsigned baud);

/// Of all PLCs: stations of a net differ, and agree in type, speed and cycle; at most 32 on one.
/// Errors say which PLCs and what to set.
Status check_nets(const std::vector<StationConfig>& stations);

}  // namespace fieldproof::xnet
