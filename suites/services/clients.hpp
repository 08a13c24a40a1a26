// What the P2P channels of an Ethernet module may speak beside the protocol that a case is about
// (FEnet EN 7.1.1, table 7-3; p2p.channels of vectors/README.md).
#pragma once

#include <vector>

#include "src/p2p/p2p_plc.hpp"

namespace fieldproof::services {

/// `own`, and the XGT and the Modbus TCP client. User-defined frames are `own` alone: they need a
/// definition.
std::vector<p2p::NetworkDriver> client_drivers(p2p::NetworkDriver own);

}  // namespace fieldproof::services
