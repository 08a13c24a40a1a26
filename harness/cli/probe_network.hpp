// `probe` on a network: nothing is searched, the servers of an address are asked.
#pragma once

#include <vector>

#include "harness/cli/commands.hpp"
#include "harness/endpoints/endpoint.hpp"

namespace fieldproof::cli {

/// The protocols whose servers are looked for: those that are named, or where the endpoint names
/// no port all that run on a network, or the one whose port it names. Empty: the endpoint is a
/// line, which is searched. Errors: named protocols of lines and of networks together.
Result<std::vector<const harness::Protocol*>> servers_to_probe(
    const ProbeOptions& options, const endpoints::EndpointName& endpoint,
    const harness::Protocols& protocols);

/// Asks them, and prints what answers and what is in the way. Exit code 0: at least one answers.
int probe_servers(const ProbeOptions& options, const endpoints::EndpointName& endpoint,
                  const std::vector<const harness::Protocol*>& wanted,
                  const harness::Protocols& protocols, std::vector<ProbedDevice>* devices);

}  // namespace fieldproof::cli
