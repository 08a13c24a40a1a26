// exec:COMMAND: the bench starts the device under test itself and gives it the other end of a pty,
// or the port that it listens on or connects to.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "harness/endpoints/endpoint.hpp"

namespace fieldproof::endpoints {

/// Runs COMMAND by /bin/sh. `{tty}` in it becomes the path of the pty; without any mark, stdin and
/// stdout are the pty. With `{port}` it is a device on a network instead, see open_exec_network.
/// It is started by the first begin(), or by the first that is sent to it or waited for.
/// `act("power_cycle")` ends it with all its children and starts it anew; so does begin() where the
/// command takes what is otherwise than in the last case (CommandMarks). Options: floor_ms,
/// station, protocol, echo. When it ends, send and receive fail and say its exit status and the
/// last lines of its stderr.
Result<std::unique_ptr<Endpoint>> open_exec(const EndpointName& name,
                                            const harness::Protocol& protocol);

/// `{port}`: a free port of 127.0.0.1, another one at each start (`{udp_port}`: for datagrams).
/// Server: COMMAND listens there; the first connection is tried until it is accepted, for 10 s.
/// Client (cases of role client): the bench listens there before COMMAND starts.
Result<std::unique_ptr<Endpoint>> open_exec_network(const EndpointName& name,
                                                    const harness::Protocol& protocol);

/// The marks in the command go together. The error is the cause alone.
Status check_command(const EndpointName& name);
/// `{port}` for protocols of networks, and for none else.
Status check_command_for(const EndpointName& name, const harness::Protocol& protocol);

/// What the command is told where no case has begun.
nlohmann::json config_of(const EndpointName& name);

/// `command` with `value` for each `mark`.
std::string with_mark(std::string command, std::string_view mark, const std::string& value);

}  // namespace fieldproof::endpoints
