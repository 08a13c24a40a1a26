// Lines of text that are done to a modelled PLC, word by word.
#pragma once

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <optional>
#include <string_view>

namespace fieldproof::xnet {

/// Words between single or more blanks.
class Words {
 public:
  explicit Words(std::string_view text) : rest_(text) {}
  /// Empty: there is none left.
  std::string_view next() {
    rest_.remove_prefix(std::min(rest_.find_first_not_of(' '), rest_.size()));
    const std::string_view word = rest_.substr(0, rest_.find(' '));
    rest_.remove_prefix(word.size());
    return word;
  }
  std::string_view rest() {
    rest_.remove_prefix(std::min(rest_.find_first_not_of(' '), rest_.size()));
    return rest_;
  }

 private:
  std::string_view rest_;
};

/// A whole number as the manual writes constants: "10", "K10", "K-1", "H0C0A8".
template <typename Whole>
std::optional<Whole> constant(std::string_view word) {
  const bool hex = word.starts_with('H');
  if (hex || word.starts_with('K')) word.remove_prefix(1);
  if (hex && (word.empty() || word.front() > '9'))
    return std::nullopt;  // H0C0A8, not HC0A8 (3-3-1)
  Whole value{};
  const char* const end = word.data() + word.size();
  const auto [stop, error] = std::from_chars(word.data(), end, value, hex ? 16 : 10);
  return error == std::errc() && stop == end ? std::optional(value) : std::nullopt;
}
inline std::optional<std::uint32_t> plain_number(std::string_view word) {
  return constant<std::uint32_t>(word);
}

}  // namespace fieldproof::xnet
