// E-mail of an Ethernet module (FEnet EN 7.4) for the harness: the device is the client of an SMTP
// server, which the bench plays. There is nothing that a bench could ask it.
#pragma once

#include "harness/protocol.hpp"

namespace fieldproof::email_suite {

const harness::Protocol& protocol();

}  // namespace fieldproof::email_suite
