// What `probe` says of a device that it has found: how to go on with it.
#pragma once

#include <string>

#include "harness/cli/commands.hpp"
#include "harness/endpoints/endpoint.hpp"
#include "harness/probe/plan.hpp"

namespace fieldproof::cli {

/// A program that the bench starts is told what the profile declares before it is asked; without
/// one what that of a module of the protocol does.
Status tell_what_to_be(endpoints::Endpoint& device, const endpoints::EndpointName& name,
                       const harness::Protocol& protocol, const std::string& profile);

/// "fieldproof run --endpoint ... --profile ...": its own module's profile is for the engineer to
/// choose. `settable`: the line has speed and frame.
std::string probe_run_line(const endpoints::EndpointName& endpoint, const probe::Trial& device,
                           bool settable);

/// The same as parts.
ProbedDevice probed_device(const endpoints::EndpointName& endpoint, const probe::Trial& device,
                           bool settable);

/// Prints the fingerprint; what went wrong is said and makes the exit code.
int print_probed_fingerprint(const endpoints::EndpointName& endpoint, const probe::Trial& device,
                             bool settable, Duration patience);

}  // namespace fieldproof::cli
