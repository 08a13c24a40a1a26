#include "harness/endpoints/kinds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "harness/endpoints/echo.hpp"
#include "harness/endpoints/emulator.hpp"
#include "harness/endpoints/exec.hpp"
#include "harness/endpoints/listen.hpp"
#include "harness/endpoints/network_name.hpp"
#include "harness/endpoints/options.hpp"
#include "harness/endpoints/pty.hpp"
#include "harness/endpoints/rfc2217.hpp"
#include "harness/endpoints/serial.hpp"
#include "harness/endpoints/tcp.hpp"
#include "harness/protocol.hpp"

namespace fieldproof::endpoints {

namespace {

constexpr std::array<std::string_view, 4> exec_keys{"protocol", "station", "floor_ms", "echo"};
constexpr std::array<std::string_view, 7> tcp_keys{"protocol", "station", "floor_ms", "udp",
                                                   "line",     "echo",    "shared"};
constexpr std::array<std::string_view, 4> udp_keys{"protocol", "station", "floor_ms", "line"};
constexpr std::array<std::string_view, 4> listen_keys{"protocol", "station", "floor_ms", "udp"};
constexpr std::array<std::string_view, 7> serial_keys{"protocol", "station", "floor_ms", "baud",
                                                      "frame",    "rs485",   "echo"};
constexpr std::array<std::string_view, 8> rfc2217_keys{"protocol", "station", "floor_ms", "baud",
                                                       "frame",    "rs485",   "echo",     "shared"};

/// Ways that carry bytes, whatever protocol they are of.
template <Result<std::unique_ptr<Endpoint>> (*open)(const EndpointName&)>
Result<std::unique_ptr<Endpoint>> plain(const EndpointName& name, const harness::Protocol&) {
  return open(name);
}

// One more endpoint is one entry here and one file.
constexpr std::array kinds{
    KindOf{.name = "emulator",
           .line = LineOption::device,
           .emulated = true,
           .simulated = true,
           .back_door = true,
           .can_restart = true,
           .lines = true,
           .connections = true,
           .datagrams = true,
           .open = open_emulator},
    KindOf{.name = "pty",
           .line = LineOption::device,
           .emulated = true,
           .back_door = true,
           .lines = true,
           .open = plain<open_pty>},
    KindOf{.name = "serial",
           .target = "/dev/ttyUSB0",
           .options = serial_keys,
           .line = LineOption::port,
           .local_port = true,
           .lines = true,
           .open = plain<open_serial>},
    KindOf{.name = "exec",
           .target = "COMMAND",
           .options = exec_keys,
           .free_target = true,
           .can_restart = true,
           .lines = true,
           .connections = true,
           .datagrams = true,
           .check = check_command,
           .check_protocol = check_command_for,
           .open = open_exec},
    KindOf{.name = "tcp",
           .target = "HOST:PORT",
           .options = tcp_keys,
           .lines = true,
           .connections = true,
           .datagrams = true,
           .check = check_network_name,
           .check_protocol = check_network_use,
           .open = open_tcp},
    KindOf{.name = "udp",
           .target = "HOST:PORT",
           .options = udp_keys,
           .lines = true,
           .datagrams = true,
           .check = check_network_name,
           .check_protocol = check_network_use,
           .open = open_udp},
    KindOf{.name = "listen",
           .target = "HOST:PORT",
           .options = listen_keys,
           .connections = true,
           .datagrams = true,
           .listens = true,
           .check = check_listen_name,
           .open = open_listen},
    KindOf{.name = "rfc2217",
           .target = "HOST:PORT",
           .options = rfc2217_keys,
           .line = LineOption::port,
           .lines = true,
           .check = check_network_name,
           .open = plain<open_rfc2217>},
};

}  // namespace

std::span<const KindOf> all_kinds() { return kinds; }

const KindOf& kind_of(const EndpointName& name) {
  static constexpr KindOf none{};
  const auto kind = std::ranges::find(kinds, name.kind, &KindOf::name);
  return kind == kinds.end() ? none : *kind;
}

Capabilities capabilities_of(const EndpointName& name) {
  const KindOf& kind = kind_of(name);
  Capabilities can;
  can.simulated = can.wire = kind.simulated;
  can.back_door = kind.back_door;
  can.real_device = !kind.emulated;
  can.can_power_cycle = kind.can_restart;
  return can;
}

Status check_endpoint(const EndpointName& name, const harness::Protocol& protocol) {
  const KindOf& kind = kind_of(name);
  const auto wrong = [&](const std::string& why) {
    return fail(
        fmt::format("cannot use {}:{} for {}: {}", name.kind, name.target, protocol.name(), why));
  };
  if (!protocol.has_frames() && !kind.simulated)
    return wrong(
        "no manual prints a frame of it, so it is tested on a model alone; write emulator:");
  if (!protocol.on_network() && !kind.lines)
    return wrong("it runs on a serial line; write serial:, rfc2217: or tcp: (a serial server)");
  if (protocol.on_network() && !kind.connections && !kind.datagrams)
    return wrong(fmt::format("it runs on a network; write {}",
                             kind.emulated ? "emulator:" + name.target : "tcp:HOST"));
  if (const Status echo = check_echo(name, protocol); !echo) return wrong(echo.error().message);
  if (!kind.check_protocol) return ok();
  const Status checked = kind.check_protocol(name, protocol);
  return checked ? ok() : Status(wrong(checked.error().message));
}

Status check_options(const EndpointName& name, const harness::Protocol& protocol) {
  const KindOf& kind = kind_of(name);
  const auto checked = [](const auto& result) { return result ? ok() : Status(result.error()); };
  if (kind.line == LineOption::port) return checked(serial_options(name));
  if (const auto floor = timing_floor(name); !floor && !kind.simulated) return floor.error();
  if (!kind.emulated) return ok();
  EndpointName trial = name;  // in process, whatever way it goes
  if (!kind.simulated)
    for (const char* of_the_way : {"floor_ms", "echo"}) trial.options.erase(of_the_way);
  return checked(open_emulator(trial, protocol));
}

const harness::Protocol& spoken_over(const EndpointName& name, const harness::Protocol& protocol) {
  const KindOf& kind = kind_of(name);
  const bool by_command = kind.free_target && name.target.find("{port}") == std::string::npos;
  const bool network = kind.connections && !name.options.contains("line") && !by_command;
  const harness::Protocol* carrier = kind.emulated ? nullptr : protocol.carried(network);
  return carrier ? *carrier : protocol;
}

EndpointName with_line(EndpointName name, const line::LineSettings& settings) {
  const std::string text = to_string(settings);
  const std::size_t dash = text.find('-');
  switch (kind_of(name).line) {
    case LineOption::none: break;
    case LineOption::device: name.options["line"] = text; break;
    case LineOption::port:
      name.options["baud"] = text.substr(0, dash);
      name.options["frame"] = text.substr(dash + 1);
      break;
  }
  return name;
}

}  // namespace fieldproof::endpoints
