// Time of a run. Simulated or real, it is nanoseconds since the endpoint was opened.
#pragma once

#include <chrono>
#include <cmath>

namespace fieldproof {

using Duration = std::chrono::nanoseconds;
using Time = std::chrono::nanoseconds;

using namespace std::chrono_literals;

inline double to_ms(Duration d) { return std::chrono::duration<double, std::milli>(d).count(); }

/// To the nearest nanosecond. `ms` is finite and within 292 years.
inline Duration from_ms(double ms) { return Duration(std::llround(ms * 1e6)); }

}  // namespace fieldproof
