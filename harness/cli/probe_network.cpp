#include "harness/cli/probe_network.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "harness/cli/probe_found.hpp"
#include "harness/endpoints/kinds.hpp"
#include "harness/probe/servers.hpp"
#include "harness/run/run_report.hpp"
#include "harness/system/interrupt.hpp"
#include "harness/system/sockets/socket_address.hpp"

namespace fieldproof::cli {

using endpoints::EndpointName;
using harness::Protocol;
using probe::ServerFinding;
using Wanted = std::vector<const Protocol*>;

namespace {

/// Those that --protocol names, or the endpoint.
Result<Wanted> named(const ProbeOptions& options, const EndpointName& endpoint,
                     const harness::Protocols& protocols) {
  std::vector<std::string> names = options.protocols;
  if (names.empty())
    if (const std::string own = endpoint.option("protocol", ""); !own.empty()) names.push_back(own);
  Wanted wanted;
  for (const std::string& name : names) {
    const Result<const Protocol*> one = protocols.choose(name, "");
    if (!one) return one.error();
    wanted.push_back(*one);
  }
  return wanted;
}

/// By the port of the endpoint, where it names one.
Wanted by_port(const EndpointName& endpoint, const harness::Protocols& protocols) {
  const Result<os::SocketName> name = os::parse_socket_name(endpoint.target);
  if (!name) return {};
  const Transport transport =
      endpoints::kind_of(endpoint).connections ? Transport::tcp : Transport::udp;
  Wanted wanted;
  for (const Protocol* one : protocols)
    if (probe::is_network_server(*one) && (!name->port || name->port == one->port_for(transport)))
      wanted.push_back(one);
  return wanted;
}

void report(const std::vector<ServerFinding>& findings, const EndpointName& endpoint) {
  for (const ServerFinding& one : findings) {
    run::tell(fmt::format("{:<13} {}\n", probe::to_string(one.kind), one.text));
    for (const std::string& limit : one.limits)
      run::tell(fmt::format("{:<13} {}\n", "limit", limit));
    if (!one.advice.empty()) run::tell(fmt::format("{:<13} {}\n", "what to do", one.advice));
    if (one.is_server())
      run::tell(fmt::format("{:<13} {}\n", "go on with",
                            probe_run_line(endpoint, {{}, one.protocol, 1}, false)));
  }
}

}  // namespace

Result<Wanted> servers_to_probe(const ProbeOptions& options, const EndpointName& endpoint,
                                const harness::Protocols& protocols) {
  const endpoints::KindOf& kind = endpoints::kind_of(endpoint);
  const bool carries = (kind.connections || kind.datagrams) && !kind.listens;
  if (!carries || endpoint.options.contains("line")) return Wanted{};
  Result<Wanted> wanted = named(options, endpoint, protocols);
  if (!wanted) return wanted;
  const auto networked = std::ranges::count_if(
      *wanted, [](const Protocol* one) { return probe::is_network_server(*one); });
  if (networked == 0)
    return wanted->empty() && !kind.emulated && !kind.free_target ? by_port(endpoint, protocols)
                                                                  : Wanted{};
  if (networked != static_cast<std::ptrdiff_t>(wanted->size()))
    return fail("cannot probe by protocols of lines and of networks at once; name one kind");
  return wanted;
}

int probe_servers(const ProbeOptions& options, const EndpointName& endpoint, const Wanted& wanted,
                  const harness::Protocols& protocols, std::vector<ProbedDevice>* devices) {
  if (!(options.stations.empty() && options.speeds.empty() && options.frames.empty()))
    return run::complain(
        fmt::format("cannot search stations, speeds and frames of {}: a network has none; leave "
                    "--station, --speed and --frame out",
                    options.endpoint),
        run::exit_code::usage);
  os::catch_interrupts();
  std::vector<std::string_view> names;
  for (const Protocol* one : wanted) names.push_back(one->name());
  run::tell(fmt::format("probing {}: {}. Only reads are sent, nothing is written.\n",
                        options.endpoint, fmt::join(names, ", ")));
  std::fflush(stdout);
  const Duration wait = std::chrono::milliseconds(options.wait_ms);
  const auto open = [&](const Protocol& protocol) {
    EndpointName name = endpoint;
    name.options["protocol"] = protocol.name();
    Result<std::unique_ptr<endpoints::Endpoint>> device = endpoints::open_endpoint(name, protocol);
    if (device)
      if (const Status told = tell_what_to_be(**device, name, protocol, options.profile); !told)
        device = told.error();
    return device;
  };
  const Result<std::vector<ServerFinding>> findings =
      probe::find_servers(open, wanted, protocols, wait);
  if (!findings)
    return run::complain(findings.error().message, findings.error().interrupted
                                                       ? run::exit_code::interrupted
                                                       : run::exit_code::trouble);
  report(*findings, endpoint);
  bool found = false;
  for (const ServerFinding& one : *findings) {
    if (!one.is_server()) continue;
    if (devices) devices->push_back(probed_device(endpoint, {{}, one.protocol, 1}, false));
    if (options.fingerprint && !found)
      if (const int code = print_probed_fingerprint(endpoint, {{}, one.protocol, 1}, false, wait);
          code != run::exit_code::ok)
        return code;
    found = true;
  }
  return found ? run::exit_code::ok : run::exit_code::failed;
}

}  // namespace fieldproof::cli
