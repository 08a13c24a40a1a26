// `probe` on a network: nothing is searched, the servers of an address are asked.
#pragma once

#include <vector>

#include "harness/cli/commands.hpp"
#include "harness/endpoints/endpoint.hpp"

namespace fieldproof::cli {

/// Which servers are looked for.
struct ServerSearch {
  std::vector<const harness::Protocol*>
      wanted{};  // none: the endpoint is a line, which is searched
  /// The port is no protocol's own: any of them may be there, or a serial server with a line
  /// behind.
  bool or_a_line = false;
};
/// The protocols that are named; else where the endpoint names no port all that run on a network,
/// or the one whose port it names, or at another port whoever answers. Errors: named protocols of
/// lines and of networks together.
Result<ServerSearch> servers_to_probe(const ProbeOptions& options,
                                      const endpoints::EndpointName& endpoint,
                                      const harness::Protocols& protocols);

/// Instead of an exit code: no server is there, and somebody who may be a serial server.
constexpr int search_a_line = -1;

/// Asks them, and prints what answers and what is in the way. Exit code 0: at least one answers.
int probe_servers(const ProbeOptions& options, const endpoints::EndpointName& endpoint,
                  const ServerSearch& search, const harness::Protocols& protocols,
                  std::vector<ProbedDevice>* devices);

}  // namespace fieldproof::cli
