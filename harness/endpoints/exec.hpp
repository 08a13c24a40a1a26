// exec:COMMAND: the bench starts the device under test itself and gives it the other end of a pty.
#pragma once

#include "harness/endpoints/endpoint.hpp"

namespace fieldproof::endpoints {

/// Runs COMMAND by /bin/sh. `{tty}` in it becomes the path of the pty; without it, stdin and stdout
/// are the pty. `act("power_cycle")` ends it with all its children and starts it anew. Options:
/// floor_ms, station, protocol. When it ends, send and receive fail and say its exit status and the
/// last lines of its stderr.
Result<std::unique_ptr<Endpoint>> open_exec(const EndpointName& name);

}  // namespace fieldproof::endpoints
