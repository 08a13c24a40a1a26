// Time of a run. Simulated or real, it is nanoseconds since the endpoint was opened.
#pragma once

#include <chrono>

namespace fieldproof {

using Duration = std::chrono::nanoseconds;
using Time = std::chrono::nanoseconds;

using namespace std::chrono_literals;

inline double to_ms(Duration d) { return std::chrono::duration<double, std::milli>(d).count(); }

}  // namespace fieldproof
