// The condition flag of a P2P block (Cnet EN table 6.2.3 'all Bit device', Cnet KO 6.3.2): a bit,
// or a clock.
//
// Clocks are F90 (20 ms), F92 (200 ms) and F93 (1 s), on XEC _T20MS, _T200MS and _T1S. Other forms
// of the same bits (F0092, %FX0092) mean the clock too.
#pragma once

#include <string_view>

#include "src/base/result.hpp"
#include "src/p2p/block.hpp"
#include "src/plc/model.hpp"

namespace fieldproof::p2p {

/// The error says what is allowed.
Result<P2pCondition> parse_p2p_condition(std::string_view flag, const plc::PlcModel& model);

}  // namespace fieldproof::p2p
