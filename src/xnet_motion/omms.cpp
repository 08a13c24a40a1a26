#include "src/xnet_motion/omms.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace fieldproof::xnet {

namespace {

Result<SerialFormat> format_of(const Servo& servo) {
  const int value = servo.parameter("P7-01");
  if (const std::optional<SerialFormat> format = serial_format(value)) return *format;
  return fail(fmt::format("P7-01 is 0x{:04X}: only what 0x2213 means is printed", value));
}

/// A parameter that counts.
unsigned count_of(const Servo& servo, const char* name) {
  return static_cast<unsigned>(std::max(servo.parameter(name), 0));
}

}  // namespace

Duration SerialFormat::time_of(unsigned characters) const {
  return Duration(static_cast<Duration::rep>(characters) * bits * 1'000'000'000 / baud);
}

std::optional<SerialFormat> serial_format(int p7_01) {
  constexpr int printed = 0x2213;  // 1 stop bit, even parity, 3 Mbit/s (note 1); 8 data bits
  if (p7_01 == printed) return SerialFormat{3'000'000, 11};
  return std::nullopt;
}

Result<std::vector<Slot>> slots_of(const Servo& servo, unsigned frame) {
  const Result<SerialFormat> format = format_of(servo);
  if (!format) return format.error();
  const unsigned space = count_of(servo, "P7-04"), stations = count_of(servo, "P7-05");
  // Each end is rounded by itself, so that nothing adds up.
  const auto end_of = [&](unsigned station) { return format->time_of(station * (frame + space)); };
  const Duration refresh = count_of(servo, "P7-07") * 1us;
  if (end_of(stations) > refresh)
    return fail(fmt::format("{} slots of {} characters take {:.0f} us, longer than P7-07 = {:.0f}",
                            stations, frame + space, to_ms(end_of(stations)) * 1000,
                            to_ms(refresh) * 1000));
  std::vector<Slot> slots;
  for (unsigned station = 1; station <= stations; ++station) {
    const Duration from = end_of(station - 1), before = format->time_of(space) / 2;
    slots.push_back(
        {station, from, end_of(station), from + before, from + before + format->time_of(frame)});
  }
  return slots;
}

Result<Duration> sampling_time(const Servo& servo) {
  const Result<SerialFormat> format = format_of(servo);
  if (!format) return format.error();
  return format->time_of(count_of(servo, "P7-03"));
}

}  // namespace fieldproof::xnet
