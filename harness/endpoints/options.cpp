#include "harness/endpoints/options.hpp"

#include <charconv>
#include <string>

namespace fieldproof::endpoints {

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

bool is_shared(const EndpointName& name) { return name.option("shared", "on") == "on"; }

Result<SerialOptions> serial_options(const EndpointName& name) {
  const auto wrong = [&](const Error& error) {
    return fail("cannot open " + name.kind + ':' + name.target + ": " + error.message);
  };
  const Result<Duration> floor = timing_floor(name);
  if (!floor) return floor.error();
  const Result<line::LineSettings> settings =
      line::parse_line_settings(name.option("baud", "9600") + '-' + name.option("frame", "8N1"));
  if (!settings) return wrong(settings.error());
  const Result<Direction> direction = parse_direction(name.option("rs485", ""));
  if (!direction) return wrong(direction.error());
  return SerialOptions{*settings, *direction, *floor};
}

}  // namespace fieldproof::endpoints
