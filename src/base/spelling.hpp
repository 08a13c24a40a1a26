// "did you mean" for a mistyped word.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace fieldproof {

/// "; did you mean 'emulator'?" for the candidate that is closest to `word`, or empty when none is
/// close: at most one slip (a wrong, missing, surplus or swapped letter; letter case does not
/// count) for every three letters, one for short words.
std::string suggestion(std::string_view word, std::span<const std::string_view> candidates);

}  // namespace fieldproof
