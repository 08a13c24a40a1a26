// The keywords under which Appendix 2 of 000 and 003 lists flags and registers of the P2P service.
//
//   _P2P1_NDR00, _P2P1_ERR00, _P2P1_STATUS00, _P2P1_SVCCNT00, _P2P1_ERRCNT00    P2P 1, block 0: in L
//   _P1B00SN, _P1B00RD1, _P1B00RS1, ... _P1B00WD4, _P1B00WS4                    the same: in N
#pragma once

#include <optional>
#include <string_view>

#include "src/p2p/registers.hpp"

namespace fieldproof {

struct P2pKeyword {
  DeviceAddress address;
  unsigned words = 0;  // that it takes; 0: a bit
};

/// Nothing where there is no such keyword, parameter (1-3) or block (00-31).
std::optional<P2pKeyword> find_p2p_keyword(const PlcModel& model, std::string_view keyword);

}  // namespace fieldproof
