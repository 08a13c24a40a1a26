// Which axis an instruction or an object of the motion bus moves, for the fence of real PLCs (X-NET
// 2-2, 2-4, 2-5).
#pragma once

#include <string>
#include <string_view>

#include "harness/protocol.hpp"
#include "src/xnet/areas.hpp"

namespace fieldproof::xnet_suite {

/// "3", or empty: it moves none. Who cannot tell says "?".
std::string axis_of_action(std::string_view action);
/// Of the objects that make an axis move, or change how it moves: SM2000, SD2000, SFD3000, HSD100
/// and what follows for 20 axes.
std::string axis_of(const xnet::Component& object);

/// Where a case begins that moves it: at 0, without an error, not enabled.
std::vector<harness::Protocol::Setting> at_rest(std::string_view axis);

}  // namespace fieldproof::xnet_suite
