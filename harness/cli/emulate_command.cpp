#include <fmt/format.h>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "harness/cli/commands.hpp"
#include "harness/cli/config_file.hpp"
#include "harness/cli/monitor_file.hpp"
#include "harness/endpoints/endpoint.hpp"
#include "harness/hosting/device_host.hpp"
#include "harness/hosting/listening.hpp"
#include "harness/monitored_device.hpp"
#include "harness/notation/notation.hpp"
#include "harness/protocol.hpp"
#include "harness/run/run_report.hpp"
#include "harness/system/interrupt.hpp"
#include "src/plc/multi_drop.hpp"

namespace fieldproof::cli {

using plc::EmulatedDevice;

namespace {

void print_traffic(const hosting::Traffic& traffic) {
  run::tell(fmt::format("{}\n", hosting::monitor_line(traffic)));
  // Binary frames have no other notation than the hex of that line.
  if (const std::string bytes = notation::print_bytes(traffic.bytes);
      bytes != to_hex(traffic.bytes))
    run::tell(fmt::format("    {}\n", bytes));
  std::fflush(stdout);
}

/// The device, whose frames are recorded, and its `neighbours` on the same line: stations, or
/// objects of config keys.
Result<std::unique_ptr<EmulatedDevice>> make_stations(const harness::Protocol& protocol,
                                                      nlohmann::json config,
                                                      const plc::FrameMonitor::Record& record) {
  const std::string model = config.value("model", protocol.models().front());
  const nlohmann::json neighbours = config.value("neighbours", nlohmann::json::array());
  config.erase("model");
  config.erase("neighbours");
  Result<std::unique_ptr<EmulatedDevice>> first =
      harness::make_monitored_device(protocol, model, config, record);
  if (!first || neighbours.empty()) return first;
  std::vector<std::unique_ptr<EmulatedDevice>> devices;
  devices.push_back(std::move(*first));
  for (const nlohmann::json& neighbour : neighbours) {
    nlohmann::json own = neighbour.is_object() ? neighbour : nlohmann::json{{"station", neighbour}};
    for (const char* shared : {"line", "rs485", "inter_character_floor_ms"})
      if (config.contains(shared) && !own.contains(shared)) own[shared] = config[shared];
    Result<std::unique_ptr<EmulatedDevice>> device = protocol.make_device(model, own);
    if (!device) return fail("neighbour " + neighbour.dump() + ": " + device.error().message);
    devices.push_back(std::move(*device));
  }
  return std::unique_ptr<EmulatedDevice>(std::make_unique<plc::MultiDrop>(std::move(devices)));
}

/// `protocol` in a file of configuration may only repeat what the command line says.
Status check_protocol_key(const nlohmann::json& config, std::string_view file,
                          const harness::Protocol& protocol) {
  const auto key = config.find("protocol");
  if (key == config.end() || *key == protocol.name()) return ok();
  return fail(fmt::format(
      "cannot use {}: protocol is {}, and this is a device of {}; write MODEL?protocol=NAME on the "
      "command line, and what serves beside it under services",
      file, key->dump(), protocol.name()));
}

/// Is the device given a way that its protocol runs on?
Status check_addresses(const EmulateOptions& options, const harness::Protocol& protocol) {
  const auto wrong = [&](const std::string& why) {
    return fail(fmt::format("cannot emulate {}: {} {}", options.model, protocol.name(), why));
  };
  if (!protocol.has_frames())
    return wrong(
        "has no frame that a manual prints, so there is nothing to serve; its cases run on a "
        "model: "
        "fieldproof run --protocol " +
        std::string(protocol.name()));
  const std::uint16_t port = protocol.default_port();
  const bool socket = !options.tcp.empty() || !options.udp.empty();
  if (port == 0 && !options.udp.empty())
    return wrong("runs on a serial line, which datagrams do not carry; leave --udp out");
  const bool line = !options.pty.empty() || !options.tty.empty();
  if (port == 0 && socket && line)
    return wrong("is on one serial line; leave --tcp, or --pty and --tty out");
  const bool only_asks = !options.p2p.empty() && !line;
  if (port != 0 && !socket && !only_asks)
    return wrong(fmt::format("runs on a network; give --tcp 127.0.0.1:{}, or another port", port));
  for (const Transport transport : {Transport::tcp, Transport::udp}) {
    const std::string& address = transport == Transport::tcp ? options.tcp : options.udp;
    const std::optional<std::uint16_t> usual =
        port != 0 ? std::optional(protocol.port_for(transport)) : std::nullopt;
    if (!address.empty())
      if (const auto read = hosting::read_address(address, usual); !read) return read.error();
  }
  return ok();
}

}  // namespace

int emulate_command(const EmulateOptions& options, const harness::Protocols& protocols) {
  const Result<endpoints::EndpointName> name =
      endpoints::parse_endpoint("emulator:" + options.model);
  if (!name) return run::complain(name.error().message, run::exit_code::usage);
  const Result<const harness::Protocol*> protocol =
      protocols.choose(name->option("protocol", ""), name->target);
  if (!protocol)
    return run::complain("cannot emulate " + options.model + ": " + protocol.error().message,
                         run::exit_code::usage);

  hosting::HostOptions host;
  host.model = name->target;
  const std::string& file = options.p2p.empty() ? options.config : options.p2p;
  if (!file.empty()) {
    const Result<nlohmann::json> config =
        options.p2p.empty() ? read_config_file(file) : read_p2p_file(file);
    if (!config) return run::complain(config.error().message, run::exit_code::usage);
    host.config = *config;
    if (const Status same = check_protocol_key(host.config, file, **protocol); !same)
      return run::complain(same.error().message, run::exit_code::usage);
  }
  for (const auto& [key, value] : name->options)
    if (key != "protocol") host.config[key] = value;
  plc::FrameMonitor::Record record;
  if (!options.monitor.empty()) {
    Result<plc::FrameMonitor::Record> opened = open_monitor_file(options.monitor, name->target);
    if (!opened) return run::complain(opened.error().message, run::exit_code::usage);
    record = std::move(*opened);
  }
  host.make_device = [protocol = *protocol, record](const nlohmann::json& config) {
    return make_stations(*protocol, config, record);
  };
  if (!file.empty())
    host.make_device = naming_file(
        std::move(host.make_device),
        fmt::format("{}, as {} (MODEL?protocol=... for another)", file, (*protocol)->name()));
  host.port = (*protocol)->default_port();
  host.udp_port = (*protocol)->datagram_port();
  if (const Status address = check_addresses(options, **protocol); !address)
    return run::complain(address.error().message, run::exit_code::usage);
  host.tcp = options.tcp;
  host.udp = options.udp;
  host.pty = options.pty;
  host.tty = options.tty;
  host.bus = options.bus;
  host.control = options.control;
  if (options.verbose) host.monitor = print_traffic;
  os::catch_interrupts();
  return hosting::host_device(host);
}

}  // namespace fieldproof::cli
