// Durations as people write them: a number and its unit.
#pragma once

#include <string_view>

#include "src/base/result.hpp"
#include "src/base/time.hpp"

namespace fieldproof {

/// Reads "500us", "20ms", "1.5s", "10m" or "8h". The error says what is allowed.
Result<Duration> parse_duration(std::string_view text);

}  // namespace fieldproof
