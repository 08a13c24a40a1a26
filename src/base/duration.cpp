#include "src/base/duration.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <string>
#include <utility>

namespace fieldproof {

namespace {

constexpr std::array<std::pair<std::string_view, double>, 5> units{
    {{"us", 1e3}, {"ms", 1e6}, {"s", 1e9}, {"m", 60e9}, {"h", 3600e9}}};
constexpr double longest = 9e18;  // nanoseconds that a Duration holds

}  // namespace

Result<Duration> parse_duration(std::string_view text) {
  double number = 0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, number, std::chars_format::fixed);
  const std::string_view unit(rest, static_cast<std::size_t>(end - rest));
  for (const auto& [name, ns] : units)
    if (error == std::errc() && unit == name && number >= 0 && number * ns < longest)
      return Duration(std::llround(number * ns));
  return fail("'" + std::string(text) + "' is no duration; write 500us, 20ms, 1s, 10m or 8h");
}

}  // namespace fieldproof
