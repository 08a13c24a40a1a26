// Which axis an instruction of the motion bus moves, for the fence of real PLCs (X-NET 2-2, 2-4,
// 2-5).
#pragma once

#include <string>
#include <string_view>

#include "harness/protocol.hpp"

namespace fieldproof::xnet_suite {

/// "3", of B "B:3", or empty: it moves none. Who cannot tell says "?".
std::string axis_of_action(std::string_view action);

/// Where a case begins that moves it: at 0, without an error, not enabled.
std::vector<harness::Protocol::Setting> at_rest(std::string_view axis);

}  // namespace fieldproof::xnet_suite
