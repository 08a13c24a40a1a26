// Options that endpoints on real time have in common.
#pragma once

#include <initializer_list>
#include <string_view>

#include "harness/endpoints/endpoint.hpp"

namespace fieldproof {

/// An error for the first option that is neither one of `own` nor one that every endpoint takes (station, protocol,
/// floor_ms).
Status check_options(const EndpointName& name, std::initializer_list<std::string_view> own);

/// Differences in time below this cannot be judged: option floor_ms (0-10000), or 20 ms.
Result<Duration> timing_floor(const EndpointName& name);

}  // namespace fieldproof
