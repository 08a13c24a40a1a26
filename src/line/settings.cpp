#include "src/line/settings.hpp"

#include <algorithm>
#include <array>
#include <charconv>

namespace fieldproof::line {

namespace {
constexpr std::array speeds{1200, 2400, 4800, 9600, 19200, 38400, 57600, 115200};
constexpr std::string_view allowed =
    "; write SPEED-DPS such as 9600-8N1: 1200 2400 4800 9600 19200 38400 57600 115200, 7 or 8 data "
    "bits, N E or O, 1 or 2 stop bits";

Error wrong(std::string_view text, std::string_view part) {
  return fail("cannot read line settings '" + std::string(text) + "': " + std::string(part) +
              std::string(allowed));
}
}  // namespace

Duration LineSettings::character_time() const {
  return Duration(static_cast<Duration::rep>(bits_per_character()) * 1'000'000'000 / baud);
}

Result<LineSettings> parse_line_settings(std::string_view text) {
  LineSettings settings;
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), settings.baud);
  if (error != std::errc{} || std::ranges::find(speeds, settings.baud) == speeds.end())
    return wrong(text, "the speed is not one of the eight");
  const std::string_view format = text.substr(static_cast<std::size_t>(rest - text.data()));
  if (format.empty()) return settings;
  if (format.size() != 4 || format[0] != '-') return wrong(text, "the character format is not DPS");
  settings.data_bits = format[1] - '0';
  settings.parity = format[2] >= 'a' ? static_cast<char>(format[2] - 'a' + 'A') : format[2];
  settings.stop_bits = format[3] - '0';
  if (settings.data_bits != 7 && settings.data_bits != 8)
    return wrong(text, "the data bits are not 7 or 8");
  if (settings.parity != 'N' && settings.parity != 'E' && settings.parity != 'O')
    return wrong(text, "the parity is not N, E or O");
  if (settings.stop_bits != 1 && settings.stop_bits != 2)
    return wrong(text, "the stop bits are not 1 or 2");
  return settings;
}

std::string to_string(const LineSettings& settings) {
  return std::to_string(settings.baud) + '-' + std::to_string(settings.data_bits) +
         settings.parity + std::to_string(settings.stop_bits);
}

}  // namespace fieldproof::line
