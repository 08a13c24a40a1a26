// The option that endpoints on real time have in common. parse_endpoint has refused those that a kind does not know.
#pragma once

#include "harness/endpoints/endpoint.hpp"

namespace fieldproof {

/// Differences in time below this cannot be judged: option floor_ms (0-10000), or 20 ms.
Result<Duration> timing_floor(const EndpointName& name);

}  // namespace fieldproof
