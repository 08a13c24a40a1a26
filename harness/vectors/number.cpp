#include "harness/vectors/number.hpp"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>

#include "src/base/bytes.hpp"

namespace fieldproof::vectors {

namespace {

struct NumberForm {
  std::string_view name;
  unsigned bits;
  bool floating;
};
constexpr std::array number_forms{NumberForm{"dec", 16, false}, NumberForm{"dec32", 32, false},
                                  NumberForm{"dec64", 64, false}, NumberForm{"float", 32, true}};

std::optional<double> value_in(std::string_view text, const NumberForm& form) {
  double number = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number);
  if (text.empty() || error != std::errc() || stop != end) return std::nullopt;
  if (form.floating) return number;
  const double half = std::ldexp(1.0, static_cast<int>(form.bits) - 1);
  const double most = form.bits == 64 ? std::ldexp(1.0, 53) : 2 * half - 1;
  if (number != std::floor(number) || number < -std::min(half, most) || number > most)
    return std::nullopt;
  return number;
}

/// The words of a number, the low one first; and back.
std::string to_digits(std::uint64_t raw, unsigned bits) {
  std::string digits;
  for (unsigned shift = 0; shift < bits; shift += 16)
    digits += hex_number(raw >> shift & 0xFFFF, 4);
  return digits;
}
std::uint64_t from_digits(std::string_view digits) {
  std::uint64_t raw = 0;
  for (std::size_t at = 0; at + 4 <= digits.size(); at += 4) {
    std::uint64_t word = 0;
    for (const char c : digits.substr(at, 4))
      word = word << 4 | static_cast<unsigned>(std::max(hex_digit(c), 0));
    raw |= word << (at * 4);
  }
  return raw;
}

std::string in_words(double number, bool floating) {
  return floating ? fmt::format("{:g}", number) : fmt::format("{:.0f}", number);
}

}  // namespace

std::string Number::digits() const {
  if (floating) return to_digits(std::bit_cast<std::uint32_t>(static_cast<float>(low)), bits);
  return to_digits(static_cast<std::uint64_t>(static_cast<std::int64_t>(low)), bits);
}

double Number::value_of(std::string_view digits) const {
  const std::uint64_t raw = from_digits(digits);
  if (floating) return std::bit_cast<float>(static_cast<std::uint32_t>(raw));
  // A limit past the signed numbers says that it is meant without a sign.
  const bool with_sign = high < std::ldexp(1.0, static_cast<int>(bits) - 1);
  if (!with_sign) return static_cast<double>(raw);
  const unsigned unused = 64 - bits;
  return static_cast<double>(static_cast<std::int64_t>(raw << unused) >> unused);
}

bool Number::holds(std::string_view digits) const {
  const double value = value_of(digits);
  if (!floating || is_range()) return value >= low && value <= high;
  return value == static_cast<double>(static_cast<float>(low));
}

std::string Number::text() const {
  const std::string first = in_words(low, floating);
  return is_range() ? first + " to " + in_words(high, floating) : first;
}
std::string Number::text_of(std::string_view digits) const {
  return in_words(value_of(digits), floating);
}

std::optional<Number> read_number(std::string_view text) {
  const std::size_t open = text.find('(');
  if (open == text.npos || !text.ends_with(')')) return std::nullopt;
  for (const NumberForm& form : number_forms) {
    if (text.substr(0, open) != form.name) continue;
    const std::string_view inside = text.substr(open + 1, text.size() - open - 2);
    const std::size_t dots = inside.find("..");
    const std::optional<double> low = value_in(inside.substr(0, dots), form);
    const std::optional<double> high =
        dots == inside.npos ? low : value_in(inside.substr(dots + 2), form);
    if (!low || !high || *low > *high) return std::nullopt;
    return Number{form.bits, form.floating, *low, *high};
  }
  return std::nullopt;
}

}  // namespace fieldproof::vectors
