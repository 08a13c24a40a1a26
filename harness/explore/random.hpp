// Choices that the same seed makes again, everywhere.
#pragma once

#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace fieldproof::explore {

class Random {
 public:
  explicit Random(std::uint64_t seed) : generator_(seed) {}

  /// 0 to `end` - 1; 0 where `end` is 0. (Distributions of the library differ from one to another.)
  std::size_t below(std::size_t end) {
    return end == 0 ? 0 : static_cast<std::size_t>(generator_() % end);
  }
  bool chance(std::size_t percent) { return below(100) < percent; }
  /// So many hex digits.
  std::string hex(std::size_t digits) {
    std::string text;
    for (std::size_t i = 0; i < digits; ++i) text += "0123456789ABCDEF"[below(16)];
    return text;
  }
  /// Of a list that is not empty.
  template <typename List>
  auto& of(List& list) {
    return list[below(list.size())];
  }

 private:
  std::mt19937_64 generator_;
};

}  // namespace fieldproof::explore
