// What `probe` says of a device that it has found: how to go on with it.
#pragma once

#include <string>

#include "harness/cli/commands.hpp"
#include "harness/endpoints/endpoint.hpp"
#include "harness/probe/plan.hpp"

namespace fieldproof::cli {

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
