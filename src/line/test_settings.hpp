// For tests: the settings of most of their lines, and the time of a character on them.
#pragma once

#include "src/line/settings.hpp"

namespace fieldproof::line::test {

inline const LineSettings n81{9600, 8, 'N', 1};
inline const Duration ct = n81.character_time();

}  // namespace fieldproof::line::test
