// Services of one PLC (Cnet EN 1.2, 6.1, 12.4; FEnet EN 6.2): one memory, each channel for itself.
#include <nlohmann/json.hpp>

#include "suites/services/broken/faults.hpp"

namespace fieldproof::services_broken {

using nlohmann::json;

namespace {

constexpr unsigned second = 2;  // channel

Behaviour memory_apart() { return {.memory_apart = true}; }

MakeBehaviour services(std::function<void(json& config, json& of_service)> edit) {
  return [=] {
    return Behaviour{.set_up = [=](json& config) {
      if (!config.contains("services")) return;
      for (auto& [name, of_service] : config["services"].items()) edit(config, of_service);
    }};
  };
}

/// What comes on the line is lost while something on the network has no answer yet.
Behaviour line_waits_for_network() {
  const auto waits = std::make_shared<bool>(false);
  return {.edge = {.hears = [waits](Burst&, unsigned channel) { return channel == 0 || !*waits; },
                   .hears_link =
                       [waits](Burst& burst) {
                         *waits = *waits || burst.event == LinkEvent::data;
                         return true;
                       },
                   .does =
                       [waits](std::vector<Burst>& doings) {
                         if (!doings.empty()) *waits = false;
                       }}};
}

/// A connection that ends takes the line with it.
Behaviour line_ends_with_connection() {
  const auto over = std::make_shared<bool>(false);
  return {.edge = {.hears = [over](Burst&, unsigned channel) { return channel == 0 || !*over; },
                   .hears_link =
                       [over](Burst& burst) {
                         *over = *over || burst.event == LinkEvent::reset ||
                                 burst.event == LinkEvent::closed;
                         return true;
                       }}};
}

/// While a frame comes on the line the network is not heard.
Behaviour one_at_a_time() {
  const auto busy = std::make_shared<Time>();
  return {.edge = {.hears =
                       [busy](Burst& burst, unsigned) {
                         *busy = burst.end();
                         return true;
                       },
                   .hears_link =
                       [busy](Burst& burst) {
                         return burst.event != LinkEvent::data || burst.start > *busy;
                       }}};
}

/// While a P2P channel has a connection the server takes none.
Behaviour asks_or_serves() {
  const auto asks = std::make_shared<bool>(false);
  return {.edge = {.hears_link =
                       [asks](Burst& burst) { return !*asks || burst.event != LinkEvent::opened; },
                   .does =
                       [asks](std::vector<Burst>& doings) {
                         for (const Burst& one : doings)
                           if (one.event == LinkEvent::opened) *asks = true;
                       }}};
}

/// A connection that the device does not take stays without an answer.
Behaviour refuses_nobody() {
  return {.edge = {.does = [](std::vector<Burst>& doings) {
            std::erase_if(doings, [](const Burst& one) {
              return one.event == LinkEvent::reset && one.link < first_own_link;
            });
          }}};
}

}  // namespace

std::vector<Fault> shared_faults() {
  return {
      {"memory_apart", "each channel has a memory of its own", memory_apart,
       "xgt_fenet/cnet_and_fenet/cnet_writes", ""},
      {"second_channel_dead", "the second channel works only where its link is enabled",
       edge({.hears = [](Burst&, unsigned channel) { return channel != second; }}),
       "xgt_cnet/channels/xgt_and_rtu", "no answer within"},
      {"line_dead_beside_network", "with the Ethernet module the built-in channels do not work",
       edge({.hears = [](Burst&, unsigned) { return false; }}),
       "modbus_tcp/cnet_and_tcp/rtu_writes_tcp_reads", "no answer within"},
      {"one_station_for_all", "all channels have the station of the first",
       services([](json& config, json& own) { own["station"] = config.value("station", 1); }),
       "modbus_tcp/cnet_and_tcp/station_is_not_unit", ""},
      {"one_base_for_all", "all Modbus servers have the bases of the first",
       services([](json& config, json& own) {
         for (const auto& [key, value] : config.items())
           if (key.ends_with("_base")) own[key] = value;
       }),
       "modbus_tcp/bases/of_each_service", ""},
      {"one_service_at_a_time", "while a frame comes on the line the network is not heard",
       one_at_a_time, "modbus_tcp/cnet_and_tcp/at_once", "no answer within"},
      {"line_waits_for_network", "half a frame on the network holds up the line",
       line_waits_for_network, "xgt_fenet/cnet_and_fenet/half_frames", "no answer within"},
      {"line_ends_with_connection", "a connection that ends takes the line with it",
       line_ends_with_connection, "modbus_tcp/cnet_and_tcp/close_is_not_the_line",
       "no answer within"},
      {"asks_or_serves", "while a P2P channel has a connection the server takes none",
       asks_or_serves, "xgt_fenet/client/and_server/three_channels", "within 500 ms on x"},
      {"refuses_nobody", "who is one too many beside P2P is not reset", refuses_nobody,
       "xgt_fenet/client/and_server/one_channel", "the device did not close the connection"},
      {"one_client_beside_channels", "P2P leaves the server one connection, whatever it has itself",
       services([](json& config, json& own) {
         if (config.value("role", "") == "client") own["connections"] = 1;
       }),
       "xgt_fenet/client/and_server/one_channel", ""},
      {"no_network_beside_line", "beside a channel of Cnet the Ethernet module hears no datagram",
       edge({.hears_link = [](Burst& burst) { return burst.event != LinkEvent::datagram; }}),
       "xgt_fenet/cnet_and_fenet/three_ways", "no answer within"},
  };
}

}  // namespace fieldproof::services_broken
