// Whole numbers in few bytes: equal neighbours once, with how many they are. What a run has of its
// cases (verdicts, revisions, replies) mostly is the same number thousands of times.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace fieldproof::history {

using Numbers = std::vector<std::int64_t>;

std::string pack(const Numbers& numbers);
/// Nothing where the bytes are not what `pack` makes.
std::optional<Numbers> unpack(std::string_view bytes);

/// The same without spelling out what is equal.
struct Repeated {
  std::int64_t number = 0;
  std::size_t count = 0;
};
std::optional<std::vector<Repeated>> unpack_repeated(std::string_view bytes);

/// Each number as its distance from the one before it, and back: rising ids become ones.
Numbers to_steps(Numbers numbers);
Numbers from_steps(Numbers steps);

}  // namespace fieldproof::history
