// Where the manual prints the flags and registers of the P2P service (Cnet EN and KO Appendix 2.1
// (3), 2.2), checked against src/p2p/registers:
//
//   {"p2p": 1, "block": 31, "flag": "services", "mk": "L700", "iec": "%LD350"}
//   {"p2p": 1, "block": 0, "register": "read 1", "mk": "N0001~0004", "iec": "%NW0001~0005"}
//
// flag: ndr, err, status, services, errors. register: station, "read 1" (the name) and "read 1
// size" to "save 4 size". Either may be "all": from the first word to the last, of the blocks up to
// `last_block` where that is given. Zeros in front of numbers mean nothing; a dword is named by its
// first word on MK. One of mk and iec may be absent.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "src/base/result.hpp"

namespace fieldproof::xgt_cnet_suite {

Status check_p2p_fact(const nlohmann::json& facts);

}  // namespace fieldproof::xgt_cnet_suite
