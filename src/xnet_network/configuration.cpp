#include "src/xnet_network/configuration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <nlohmann/json.hpp>

#include "src/plc/config_reader.hpp"
#include "src/xnet_motion/motion_bus.hpp"
#include "src/xnet_network/instruction.hpp"

namespace fieldproof::xnet {

namespace {

using nlohmann::json;

constexpr std::array<std::string_view, 11> station_keys{"as_shipped",  // this one always is
                                                        "ip",         "mode",    "model",  "name",
                                                        "ports",      "program", "routes", "servos",
                                                        "station",    "stations"};
constexpr unsigned servos_at_first = 10;  // 2-4
constexpr std::array<std::string_view, 8> port_keys{"baud", "cable_m", "cycle_ms", "max_station",
                                                    "net",  "peer",    "port",     "station"};
constexpr std::array<std::string_view, 3> route_keys{"gateway", "net", "port"};
constexpr unsigned slowest = 600, fastest = 3'000'000;
constexpr Duration shortest_cycle = 1ms;  // its register counts milliseconds

Error wrong(const std::string& what) {
  return fail(fmt::format("cannot configure the PLC: {}", what));
}

/// Who is on the net (1-1-3, 1-4): the type of net that goes with it.
Result<NetType> type_for(const std::string& peer) {
  if (peer == "plc") return NetType::tbn;
  if (peer == "servo") return NetType::omms;
  if (peer == "analog") return NetType::ppf;
  return wrong(fmt::format("peer '{}'; there are plc (TBN), servo (OMMS), analog (PPF)", peer));
}

/// A motion bus is at the BD board of XDC and XDE, and at port 2 of XG1, with the speed of the
/// servos (2-1-2, 2-6).
Status check_servo_port(const Port& port, const Model& model) {
  if (port.type != NetType::omms) return ok();
  if (!model.motion)
    return wrong(
        fmt::format("peer servo: {} has no motion bus; XDC, XDE and XG1 have", model.name));
  const unsigned due = motion_port(model);
  if (port.number != due)
    return wrong(fmt::format("peer servo at port {}; the motion bus of {} is at port {}",
                             port.number, model.name, due));
  if (port.baud != fastest)
    return wrong(fmt::format("{} bit/s at port {}; servos have {} (P7-01 0x2213)", port.baud,
                             port.number, fastest));
  return ok();
}

Status check_port(const Port& port, const Model& model, unsigned cable) {
  if (port.number < model.first_port || port.number > model.last_port)
    return wrong(fmt::format("port {}; serial ports of {} are {} to {}, \"ip\" is port 9",
                             port.number, model.name, model.first_port, model.last_port));
  if (port.station == 0 || port.station > last_station)
    return wrong(fmt::format("station {} at port {}; stations of TBN are 1 to {}", port.station,
                             port.number, last_station));
  if (port.max_station == 0 || port.max_station > last_station)
    return wrong(fmt::format("max_station {} at port {}; it is 1 to {}", port.max_station,
                             port.number, last_station));
  if (port.station > port.max_station)
    return wrong(fmt::format("station {} at port {} is past max_station {}", port.station,
                             port.number, port.max_station));
  if (port.baud < slowest || port.baud > fastest)
    return wrong(fmt::format("{} bit/s at port {}; TBN_RS485 has {} to {}", port.baud, port.number,
                             slowest, fastest));
  if (port.cycle < shortest_cycle)
    return wrong(
        fmt::format("cycle_ms {:g} at port {}; it is the time in which each station has the "
                    "token once, 1 ms or more",
                    to_ms(port.cycle), port.number));
  if (const std::optional<unsigned> reach = longest_cable(port.baud); reach && cable > *reach)
    return wrong(
        fmt::format("a cable of {} m at {} bit/s; it reaches {} m", cable, port.baud, *reach));
  return ok();
}

Result<Port> read_port(const json& object, const Model& model) {
  constexpr const char* what = "a port of X-NET";
  if (const Status known = plc::known_keys(object, what, port_keys); !known) return known.error();
  Port port;
  unsigned net = port.net, station = port.station, cable = 0;
  std::string peer = "plc";
  plc::ConfigReader reader(object, what);
  reader.whole("port", 255, port.number);
  reader.whole("net", 0xFFFF, net);
  reader.whole("station", 0xFFFF, station);
  reader.whole("baud", 100'000'000, port.baud);
  reader.milliseconds("cycle_ms", port.cycle);
  reader.whole("max_station", 0xFFFF, port.max_station);
  reader.whole("cable_m", 1'000'000, cable);
  reader.text("peer", peer);
  if (reader.error()) return *reader.error();
  const Result<NetType> type = type_for(peer);
  if (!type) return type.error();
  port.type = *type;
  port.net = static_cast<std::uint16_t>(net);
  port.station = static_cast<std::uint16_t>(station);
  if (const Status right = check_port(port, model, cable); !right) return right.error();
  if (const Status right = check_servo_port(port, model); !right) return right.error();
  return port;
}

Result<Route> read_route(const json& object, const StationConfig& station) {
  constexpr const char* what = "a route of X-NET";
  if (const Status known = plc::known_keys(object, what, route_keys); !known) return known.error();
  Route route;
  unsigned net = 0, gateway = 0;
  plc::ConfigReader reader(object, what);
  reader.whole("net", 0xFFFF, net);
  reader.whole("port", 255, route.port);
  reader.whole("gateway", 0xFFFF, gateway);
  if (reader.error()) return *reader.error();
  if (!object.contains("net") || !object.contains("port"))
    return wrong("a route without \"net\" or \"port\"; it says which net is reached by which port");
  const Port* port = station.port(route.port);
  if (!port)
    return wrong(
        fmt::format("the route to net {} goes by port {}, which has no X-NET", net, route.port));
  if (gateway == 0 && port->net != net)
    return wrong(
        fmt::format("the route to net {} has no gateway, and port {} is on net {}; give "
                    "the station that forwards",
                    net, route.port, port->net));
  if (port->type == NetType::tbn && gateway > last_station)
    return wrong(fmt::format("the route to net {} has gateway {}; stations of TBN are 1 to {}", net,
                             gateway, last_station));
  if (gateway == port->station)
    return wrong(fmt::format("the route to net {} has this PLC itself as gateway", net));
  route.net = static_cast<std::uint16_t>(net);
  route.gateway = static_cast<std::uint16_t>(gateway);
  return route;
}

/// Addresses end with 1 to 254 (3-1-2).
Status read_ethernet(const json& config, StationConfig& station) {
  if (!config.contains("ip")) return ok();
  if (!station.model->ethernet)
    return wrong(
        fmt::format("\"ip\": {} has no Ethernet; XDE, XD5E and XG1 have", station.model->name));
  const std::optional<NetAndStation> own =
      config["ip"].is_string() ? from_ip(config["ip"].get<std::string>()) : std::nullopt;
  if (!own || (own->station & 0xFF) == 0 || (own->station & 0xFF) == 255)
    return wrong(fmt::format("\"ip\": {} is no address of a PLC; write 192.168.A.B, B 1 to 254",
                             config["ip"].dump()));
  Port port{ethernet_port, NetType::ethernet};
  port.net = own->net;
  port.station = own->station;
  station.ports.push_back(port);
  station.ethernet.address = static_cast<std::uint32_t>(own->net) << 16 | own->station;
  station.ethernet.gateway = (station.ethernet.address & 0xFFFFFF00) | 1;
  return ok();
}

Status read_ports(const json& config, StationConfig& station) {
  for (const json& one : config.value("ports", json::array())) {
    const Result<Port> port = read_port(one, *station.model);
    if (!port) return port.error();
    if (station.port(port->number)) return wrong(fmt::format("port {} stands twice", port->number));
    station.ports.push_back(*port);
  }
  return read_ethernet(config, station);
}

Status read_routes(const json& config, StationConfig& station) {
  for (const json& one : config.value("routes", json::array())) {
    const Result<Route> route = read_route(one, station);
    if (!route) return route.error();
    if (station.route(route->net)) return wrong(fmt::format("two routes to net {}", route->net));
    station.routes.push_back(*route);
  }
  if (config.contains("routes")) return ok();
  for (const Port& port : station.ports)
    if (!station.route(port.net)) station.routes.push_back({port.net, port.number, 0});
  return ok();
}

/// Rightly set up, at 0; or as a list says.
Status read_servos(const json& config, StationConfig& station) {
  const json& own = config.contains("servos") ? config["servos"] : json(servos_at_first);
  if (!station.model->motion) {
    if (!config.contains("servos")) return ok();
    return wrong(fmt::format("\"servos\": {} has no motion bus; XDC, XDE and XG1 have",
                             station.model->name));
  }
  json list = own;
  if (own.is_number_unsigned()) {
    list = json::array();
    const auto count = own.get<std::uint64_t>();
    if (count > last_axis)
      return wrong(fmt::format("\"servos\": {}; a motion bus has up to {}", count, last_axis));
    if (count > servos_at_first) station.slaves = 20;
    for (unsigned axis = 1; axis <= count; ++axis)
      list.push_back({{"axis", axis},
                      {"P7-05", count > servos_at_first ? 20 : 10},
                      {"P7-07", count > servos_at_first ? 6000 : 3000}});
  }
  if (!list.is_array()) return wrong("\"servos\" is no list, nor how many there are");
  for (const json& one : list) {
    Result<Servo> servo = read_servo(one);
    if (!servo) return servo.error();
    if (std::ranges::count(station.servos, servo->axis, &Servo::axis) > 0)
      return wrong(fmt::format("two servos are axis {}", servo->axis));
    station.servos.push_back(std::move(*servo));
  }
  return ok();
}

/// {"M100": "REG_READ net 1 station 2 D0 count 10 to D10", "M101": "hold BIT_WRITE ..."}
Status read_program(const json& config, StationConfig& station) {
  const json program = config.value("program", json::object());
  if (!program.is_object())
    return wrong(R"("program" is no object; write {"M100": "REG_READ net 1 station 2 D0 ..."})");
  for (const auto& [name, text] : program.items()) {
    const std::optional<Component> relay = find_component(name, station.model->series);
    if (!relay || !relay->area->bits)
      return wrong(
          fmt::format("program: {} has no relay '{}'; write M100", station.model->name, name));
    Rung rung{*relay, text.is_string() ? text.get<std::string>() : text.dump()};
    constexpr std::string_view hold = "hold ";
    if ((rung.level = rung.instruction.starts_with(hold))) rung.instruction.erase(0, hold.size());
    if (!is_instruction(rung.instruction) && !MotionBus::knows(rung.instruction))
      return wrong(
          fmt::format("program: '{}' at {} is no instruction of X-NET", rung.instruction, name));
    if (const Status right = check_instruction(rung.instruction, *station.model); !right)
      return wrong(fmt::format("program: {}", right.error().message));
    station.program.push_back(std::move(rung));
  }
  return ok();
}

}  // namespace

const std::vector<Model>& models() {
  static const std::vector<Model> all{
      {"xd3", Series::xd3, 5, 8000},
      {"xd2", Series::xd3, 5, 8000},
      {"xl3", Series::xd3, 5, 8000, false, false, 1, 2},
      {"xd5", Series::xd5, 10, 60000},
      {"xdm", Series::xd5, 10, 70000},
      {"xdc", Series::xd5, 10, 70000, false, true},
      {"xde", Series::xd5, 20, 70000, true, true},
      {"xd5e", Series::xd5, 20, 70000, true},
      {"xg1", Series::xd5, 20, 70000, true, true, 1, 2},
  };
  return all;
}

const Model* find_model(std::string_view name) {
  const auto found = std::ranges::find(models(), name, &Model::name);
  return found == models().end() ? nullptr : &*found;
}

const Memory& blank_memory(const Model& model) {
  static const std::vector<Memory> all = [] {
    std::vector<Memory> blank;
    for (const Model& one : models()) blank.emplace_back(one.series, one.d);
    return blank;
  }();
  return all[static_cast<std::size_t>(&model - models().data())];
}

Status check_instruction(std::string_view text, const Model& model) {
  const Memory& memory = blank_memory(model);
  if (!MotionBus::knows(text)) {
    const auto read = read_instruction(text, memory);
    return read ? ok() : Status(read.error());
  }
  if (!model.motion)
    return fail(fmt::format("cannot execute '{}': {} has no motion bus; XDC, XDE and XG1 have",
                            text, model.name));
  return MotionBus::check(text, memory);
}

unsigned motion_port(const Model& model) { return model.name == "xg1" ? 2 : 4; }

const Port* StationConfig::port(unsigned number) const {
  const auto found = std::ranges::find(ports, number, &Port::number);
  return found == ports.end() ? nullptr : &*found;
}

const Route* StationConfig::route(std::uint32_t net) const {
  const auto found = std::ranges::find(routes, net, &Route::net);
  return found == routes.end() ? nullptr : &*found;
}

std::optional<NetAndStation> from_ip(std::string_view address) {
  std::array<unsigned, 4> bytes{};
  const char *at = address.data(), *const end = at + address.size();
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    if (i > 0 && (at == end || *at++ != '.')) return std::nullopt;
    const auto [stop, error] = std::from_chars(at, end, bytes[i]);
    if (error != std::errc() || bytes[i] > 255) return std::nullopt;
    at = stop;
  }
  if (at != end) return std::nullopt;
  return NetAndStation{static_cast<std::uint16_t>(bytes[0] << 8 | bytes[1]),
                       static_cast<std::uint16_t>(bytes[2] << 8 | bytes[3])};
}

Result<StationConfig> read_station(const json& config, std::string name) {
  constexpr const char* what = "a PLC on X-NET";
  if (const Status known = plc::known_keys(config, what, station_keys); !known)
    return known.error();
  StationConfig station;
  station.name = std::move(name);
  std::string model = "xd3";
  plc::ConfigReader reader(config, what);
  reader.text("name", station.name);
  reader.text("model", model);
  reader.either("mode", "run", "stop", station.run);
  if (reader.error()) return *reader.error();
  station.model = find_model(model);
  if (!station.model) {
    std::vector<std::string_view> names;
    for (const Model& one : models()) names.push_back(one.name);
    return wrong(fmt::format("model '{}'; there are {}", model, fmt::join(names, ", ")));
  }
  if (const Status read = read_ports(config, station); !read) return read.error();
  if (const Status read = read_routes(config, station); !read) return read.error();
  if (const Status read = read_servos(config, station); !read) return read.error();
  if (const Status read = read_program(config, station); !read) return read.error();
  return station;
}

std::optional<unsigned> longest_cable(unsigned baud) {
  constexpr std::array<std::pair<unsigned, unsigned>, 4> rows{
      {{187'500, 1000}, {500'000, 400}, {1'500'000, 200}, {3'000'000, 100}}};
  for (const auto& [fastest_of_row, metres] : rows)
    if (baud <= fastest_of_row) return metres;
  return std::nullopt;
}

namespace {

/// One port of one PLC, for messages.
struct OnNet {
  const StationConfig* plc;
  const Port* port;
  std::string named() const { return fmt::format("{} port {}", plc->name, port->number); }
};

Status check_pair(const OnNet& a, const OnNet& b) {
  if (a.plc == b.plc)
    return wrong(fmt::format("{} has two ports on net {}, {} and {}; give each net its own NetID",
                             a.plc->name, a.port->net, a.port->number, b.port->number));
  const auto differ = [&](const char* what) {
    return wrong(fmt::format("{} and {} are on net {}, and their {} differ", a.named(), b.named(),
                             a.port->net, what));
  };
  if (a.port->station == b.port->station)
    return wrong(fmt::format("{} and {} are both station {} of net {}; give each its own",
                             a.named(), b.named(), a.port->station, a.port->net));
  if (a.port->type != b.port->type) return differ("types");
  if (a.port->type == NetType::ethernet) return ok();
  if (a.port->baud != b.port->baud) return differ("speeds");
  if (a.port->cycle != b.port->cycle) return differ("cycles");
  return ok();
}

}  // namespace

Status check_nets(const std::vector<StationConfig>& stations) {
  std::vector<OnNet> all;
  for (const StationConfig& plc : stations) {
    if (std::ranges::count(stations, plc.name, &StationConfig::name) > 1)
      return wrong(fmt::format("two PLCs are called {}", plc.name));
    for (const Port& port : plc.ports) all.push_back({&plc, &port});
  }
  for (std::size_t i = 0; i < all.size(); ++i)
    for (std::size_t j = i + 1; j < all.size(); ++j)
      if (all[i].port->net == all[j].port->net)
        if (const Status right = check_pair(all[i], all[j]); !right) return right;
  return ok();
}

}  // namespace fieldproof::xnet
