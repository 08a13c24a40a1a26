#include <cstdio>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "harness/cli/commands.hpp"
#include "harness/endpoints/device_host.hpp"
#include "harness/endpoints/endpoint.hpp"
#include "harness/endpoints/interrupt.hpp"
#include "harness/notation/notation.hpp"
#include "harness/protocol.hpp"
#include "src/base/spelling.hpp"

namespace fieldproof {

namespace {

void print_traffic(const Traffic& traffic) {
  fmt::print("{}\n    {}\n", monitor_line(traffic), print_bytes(traffic.bytes));
  std::fflush(stdout);
}

std::string protocol_names() {
  std::string names;
  for (const Protocol* one : protocols()) names += (names.empty() ? "" : ", ") + std::string(one->name());
  return names;
}

}  // namespace

int emulate_command(const EmulateOptions& options) {
  const Result<EndpointName> name = parse_endpoint("emulator:" + options.model);
  if (!name) return complain(name.error().message, exit_code::usage);
  const std::string protocol_name = name->option("protocol", "xgt-cnet");
  const Protocol* protocol = find_protocol(protocol_name);
  if (!protocol) return complain(fmt::format("no protocol '{}'; there are {}", protocol_name, protocol_names()), exit_code::usage);

  HostOptions host;
  host.model = name->target;
  for (const auto& [key, value] : name->options)
    if (key != "protocol") host.config[key] = value;
  host.make_device = [protocol](const nlohmann::json& config) -> Result<std::unique_ptr<EmulatedDevice>> {
    const std::string model = config.value("model", "xbc-h");
    nlohmann::json rest = config;
    rest.erase("model");
    return protocol->make_device(model, rest);
  };
  host.tcp = options.tcp;
  host.tty = options.tty.empty() ? options.pty : options.tty;
  host.control = options.control;
  if (options.verbose) host.monitor = print_traffic;
  catch_interrupts();
  return host_device(host);
}

}  // namespace fieldproof
