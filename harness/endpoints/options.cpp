#include "harness/endpoints/options.hpp"

#include <charconv>
#include <string>

namespace fieldproof {

Result<Duration> timing_floor(const EndpointName& name) {
  const std::string text = name.option("floor_ms", "20");
  int value = -1;
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || rest != text.data() + text.size() || value < 0 || value > 10'000) {
    return fail("cannot open " + name.kind + ':' + name.target + ": floor_ms is '" + text +
                "'; write milliseconds from 0 to 10000");
  }
  return Duration(std::chrono::milliseconds(value));
}

}  // namespace fieldproof
