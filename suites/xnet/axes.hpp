// Which axis an instruction of the motion bus moves, for the fence of real PLCs (X-NET 2-2, 2-4,
// 2-5); and what is seen of one under way.
#pragma once

#include <string>
#include <string_view>

#include "harness/protocol.hpp"
#include "src/xnet/areas.hpp"

namespace fieldproof::xnet_suite {

/// "3", of B "B:3", or empty: it moves none. Who cannot tell says "?".
std::string axis_of_action(std::string_view action);

/// Where a case begins that moves it: at 0, without an error, not enabled.
std::vector<harness::Protocol::Setting> at_rest(std::string_view axis);

/// harness::Protocol::of_a_moment: on the way to the last look an axis may be anywhere, unless the
/// look says that it stands; in the last one it does, unless that says that it moves.
std::vector<bool> looks_under_way(const std::vector<harness::Protocol::Look>& looks,
                                  xnet::Series series);

}  // namespace fieldproof::xnet_suite
