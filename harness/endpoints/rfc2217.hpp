// rfc2217:HOST:PORT: a serial port of another host, through a telnet server with COM-PORT-OPTION
// such as ser2net.
#pragma once

#include "harness/endpoints/endpoint.hpp"

namespace fieldproof::endpoints {

/// Options: baud (default 9600), frame (8N1), rs485 (rts: the bench switches RTS over the network),
/// floor_ms, station, protocol. The server's buffers are purged when the connection is opened, and
/// never between cases: what comes there is judged. A connection that ended is opened again at the
/// begin of the next case, and `line_errors` says so. capabilities().wire is false: a network moves
/// bytes by milliseconds, and the far port may be a pty (then has_no_wire() is to be told).
Result<std::unique_ptr<Endpoint>> open_rfc2217(const EndpointName& name);

/// `patience`: how long the server may take to confirm anything.
Result<std::unique_ptr<Endpoint>> open_rfc2217(const EndpointName& name, Duration patience);

}  // namespace fieldproof::endpoints
