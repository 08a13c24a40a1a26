// What the P2P channels of an Ethernet module may speak beside the protocol that a case is about
// (FEnet EN 7.1.1, table 7-3; p2p.channels of vectors/README.md).
#pragma once

#include <string_view>
#include <vector>

#include "src/p2p/p2p_plc.hpp"

namespace fieldproof::services {

/// The XGT and the Modbus TCP client, the one that is named first.
std::vector<p2p::NetworkDriver> client_drivers(std::string_view first = {});
/// `own` before those: user-defined frames, which need a definition.
std::vector<p2p::NetworkDriver> client_drivers(p2p::NetworkDriver own);

}  // namespace fieldproof::services
