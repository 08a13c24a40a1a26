// The endpoint that is probed: which settings it has, how it is opened with them, and its name once
// they are known.
#pragma once

#include <string>

#include "harness/endpoints/endpoint.hpp"
#include "harness/probe/prober.hpp"

namespace fieldproof::probe {

/// Does this kind of endpoint take a speed and a frame? Sockets and programs have none. (A serial
/// port may still turn out to be a pty when it is opened.)
bool has_line_settings(const endpoints::EndpointName& name);

/// Is it our own emulator? Its options describe the device, and so they do not narrow the search.
bool is_emulator(const endpoints::EndpointName& name);

/// `name` with the bench's side of the line set.
endpoints::EndpointName with_settings(endpoints::EndpointName name, const line::LineSettings& line);
LineOpener line_opener(const endpoints::EndpointName& name, const harness::Protocol& protocol);

/// `name` as it is to be used for what was found: settings, station and protocol added; an emulator
/// has them already.
endpoints::EndpointName name_of_found(const endpoints::EndpointName& name, const Trial& found,
                                      bool settable);
/// "serial:/dev/ttyUSB0?baud=9600&frame=8N1", as parse_endpoint reads it.
std::string to_string(const endpoints::EndpointName& name);

}  // namespace fieldproof::probe
