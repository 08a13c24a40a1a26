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

Wanted all_servers(const harness::Protocols& protocols) {
  Wanted all;
  std::ranges::copy_if(protocols, std::back_inserter(all),
                       [](const Protocol* one) { return probe::is_network_server(*one); });
  return all;
}

/// Does a command take a port to listen on?
bool names_a_port(const EndpointName& endpoint) {
  return endpoint.target.find("{port}") != std::string::npos;
}

/// What only lines have.
bool asks_for_a_line(const ProbeOptions& options) {
  return !(options.stations.empty() && options.speeds.empty() && options.frames.empty());
}

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
ServerSearch by_port(const EndpointName& endpoint, const harness::Protocols& protocols) {
  const Result<os::SocketName> name = os::parse_socket_name(endpoint.target);
  if (!name) return {};
  const endpoints::KindOf& kind = endpoints::kind_of(endpoint);
  const Transport transport = kind.connections ? Transport::tcp : Transport::udp;
  ServerSearch search;
  for (const Protocol* one : protocols)
    if (probe::is_network_server(*one) && (!name->port || name->port == one->port_for(transport)))
      search.wanted.push_back(one);
  if (search.wanted.empty()) return {all_servers(protocols), true};
  return search;
}

/// Where one protocol is asked for: an endpoint that names no port for datagrams, and none but the
/// protocol's own for connections, leaves the module's other port to be asked, too; a port for
/// datagrams that is another protocol's is not this one's.
EndpointName place_of(const Protocol& protocol, EndpointName name,
                      const harness::Protocols& protocols) {
  const endpoints::KindOf& kind = endpoints::kind_of(name);
  const Result<os::SocketName> target = os::parse_socket_name(name.target);
  const auto is_port_of = [&](const Protocol& one) {
    return one.on_network() && name.option("udp", "") == std::to_string(one.datagram_port());
  };
  if (!name.options.contains("protocol") && !is_port_of(protocol) &&
      std::ranges::any_of(protocols, [&](const Protocol* one) { return is_port_of(*one); }))
    name.options.erase("udp");
  else if (kind.connections && !kind.emulated && !kind.free_target && target &&
           target->port.value_or(protocol.default_port()) == protocol.default_port() &&
           protocol.datagram_port() != protocol.default_port())
    name.options.emplace("udp", std::to_string(protocol.datagram_port()));
  name.options["protocol"] = protocol.name();
  return name;
}

/// The device to go on with: with its port for datagrams, where that answers.
EndpointName name_of_server(const EndpointName& endpoint, const Protocol& protocol,
                            const std::vector<ServerFinding>& findings,
                            const harness::Protocols& protocols) {
  const bool datagrams = std::ranges::any_of(findings, [&](const ServerFinding& one) {
    return one.is_server() && one.protocol == &protocol && one.transport == Transport::udp;
  });
  const EndpointName place = place_of(protocol, endpoint, protocols);
  EndpointName name = endpoint;
  if (datagrams && place.options.contains("udp")) name.options["udp"] = place.option("udp", "");
  return name;
}

/// Those that answer, each once.
Wanted found_among(const std::vector<ServerFinding>& findings) {
  Wanted found;
  for (const ServerFinding& one : findings)
    if (one.is_server() && std::ranges::count(found, one.protocol) == 0)
      found.push_back(one.protocol);
  return found;
}

void report(const std::vector<ServerFinding>& findings) {
  for (const ServerFinding& one : findings) {
    run::tell(fmt::format("{:<13} {}\n", probe::to_string(one.kind), one.text));
    for (const std::string& limit : one.limits)
      run::tell(fmt::format("{:<13} {}\n", "limit", limit));
    if (!one.advice.empty()) run::tell(fmt::format("{:<13} {}\n", "what to do", one.advice));
  }
}

/// Every protocol at its place; at one port for all, the one that answers there.
Result<std::vector<ServerFinding>> find(const ServerSearch& search,
                                        const probe::NetworkOpener& open,
                                        const harness::Protocols& protocols, Duration wait) {
  if (!search.or_a_line) return probe::find_servers(open, search.wanted, protocols, wait);
  Result<std::vector<ServerFinding>> findings =
      probe::find_servers(open, {search.wanted.front()}, protocols, wait);
  if (!findings) return findings;
  const auto other = std::ranges::find(*findings, ServerFinding::Kind::other, &ServerFinding::kind);
  return other == findings->end() ? findings
                                  : probe::find_servers(open, {other->protocol}, protocols, wait);
}

/// Is somebody there who could be a serial server?
bool somebody_is_there(const std::vector<ServerFinding>& findings) {
  return std::ranges::any_of(findings, [](const ServerFinding& one) {
    return one.kind != ServerFinding::Kind::refused && one.kind != ServerFinding::Kind::unreachable;
  });
}

}  // namespace

Result<ServerSearch> servers_to_probe(const ProbeOptions& options, const EndpointName& endpoint,
                                      const harness::Protocols& protocols) {
  const endpoints::KindOf& kind = endpoints::kind_of(endpoint);
  const bool carries = (kind.connections || kind.datagrams) && !kind.listens;
  if (!carries || endpoint.options.contains("line")) return ServerSearch{};
  Result<Wanted> wanted = named(options, endpoint, protocols);
  if (!wanted) return wanted.error();
  const auto networked = std::ranges::count_if(
      *wanted, [](const Protocol* one) { return probe::is_network_server(*one); });
  if (networked != 0 && networked != static_cast<std::ptrdiff_t>(wanted->size()))
    return fail("cannot probe by protocols of lines and of networks at once; name one kind");
  if (!wanted->empty()) return ServerSearch{networked != 0 ? *wanted : Wanted{}, false};
  if (kind.free_target)
    return ServerSearch{names_a_port(endpoint) ? all_servers(protocols) : Wanted{}, false};
  ServerSearch search = kind.emulated ? ServerSearch{} : by_port(endpoint, protocols);
  if (search.or_a_line && asks_for_a_line(options)) return ServerSearch{};
  return search;
}

int probe_servers(const ProbeOptions& options, const EndpointName& endpoint,
                  const ServerSearch& search, const harness::Protocols& protocols,
                  std::vector<ProbedDevice>* devices) {
  if (asks_for_a_line(options))
    return run::complain(
        fmt::format("cannot search stations, speeds and frames of {}: a network has none; leave "
                    "--station, --speed and --frame out",
                    options.endpoint),
        run::exit_code::usage);
  os::catch_interrupts();
  std::vector<std::string_view> names;
  for (const Protocol* one : search.wanted) names.push_back(one->name());
  run::tell(fmt::format("probing {}: {}. Only reads are sent, nothing is written.\n",
                        options.endpoint, fmt::join(names, ", ")));
  std::fflush(stdout);
  const Duration wait = std::chrono::milliseconds(options.wait_ms);
  const auto open = [&](const Protocol& protocol) {
    const EndpointName name = place_of(protocol, endpoint, protocols);
    Result<std::unique_ptr<endpoints::Endpoint>> device = endpoints::open_endpoint(name, protocol);
    if (device)
      if (const Status told = tell_what_to_be(**device, name, protocol, options.profile); !told)
        device = told.error();
    return device;
  };
  const Result<std::vector<ServerFinding>> findings = find(search, open, protocols, wait);
  if (!findings)
    return run::complain(findings.error().message, findings.error().interrupted
                                                       ? run::exit_code::interrupted
                                                       : run::exit_code::trouble);
  const Wanted found = found_among(*findings);
  if (found.empty() && search.or_a_line && somebody_is_there(*findings)) {
    run::tell(
        fmt::format("{:<13} is there; looking for a line behind a serial server\n", "no server"));
    return search_a_line;
  }
  report(*findings);
  for (const Protocol* one : found) {
    const EndpointName name = name_of_server(endpoint, *one, *findings, protocols);
    run::tell(fmt::format("{:<13} {}\n", "go on with", probe_run_line(name, {{}, one, 1}, false)));
    if (devices) devices->push_back(probed_device(name, {{}, one, 1}, false));
  }
  if (options.fingerprint && !found.empty())
    return print_probed_fingerprint(endpoint, {{}, found.front(), 1}, false, wait);
  return found.empty() ? run::exit_code::failed : run::exit_code::ok;
}

}  // namespace fieldproof::cli
