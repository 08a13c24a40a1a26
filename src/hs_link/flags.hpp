// Where the flags of the high-speed link are in L (FEnet EN Appendix A.4, table A.1).
//
//   link 1 from L0, link 2 from L26, in words: + 0 bit 0 RLINK, bit 1 LTRBL; + 2 STATE, + 6 MOD,
//   + 10 TRX, + 14 ERR, + 18 SETBLOCK, four words each: block k is bit k mod 16 of word k / 16.
#pragma once

#include "src/plc/address.hpp"

namespace fieldproof::hs_link {

enum class Flag { rlink, ltrbl, state, mod, trx, err, setblock };

/// A bit of L. `block`: 0 to 63; 0 for RLINK and LTRBL.
plc::DeviceAddress flag_address(const plc::PlcModel& model, unsigned link, Flag flag,
                                unsigned block = 0);

}  // namespace fieldproof::hs_link
