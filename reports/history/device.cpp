#include "reports/history/device.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdio>
#include <ctime>
#include <set>

#include "reports/text/xml_text.hpp"

namespace fieldproof::history {

namespace {

std::string one_device(const results::DutInfo& dut, const std::string& profile) {
  const results::Identity& device = dut.identity;
  const char* gap = device.maker.empty() || device.model.empty() ? "" : " ";
  const std::string type = device.maker + gap + device.model;
  if (!device.serial.empty())
    return fmt::format("{}{}serial number {}", type, type.empty() ? "" : ", ", device.serial);
  if (!device.name.empty())
    return type.empty() ? device.name : fmt::format("{} ({})", device.name, type);
  return fmt::format("{}, profile {}", dut.endpoint, profile);
}

}  // namespace

std::string device_of(const results::RunInfo& run) {
  std::set<std::string> devices;
  for (const results::DutInfo& dut : run.duts) devices.insert(one_device(dut, run.profile));
  if (devices.empty()) devices.insert(one_device({run.endpoint, {}, run.identity}, run.profile));
  return text::xml_line(fmt::format("{}", fmt::join(devices, " + ")));
}

std::optional<std::int64_t> seconds_of(const std::string& timestamp) {
  std::tm time{};
  char sign = 0;
  int zone_hours = 0, zone_minutes = 0, read = 0;
  const int fields =
      std::sscanf(timestamp.c_str(), "%4d-%2d-%2dT%2d:%2d:%2d%n%c%2d:%2d%n", &time.tm_year,
                  &time.tm_mon, &time.tm_mday, &time.tm_hour, &time.tm_min, &time.tm_sec, &read,
                  &sign, &zone_hours, &zone_minutes, &read);
  const bool utc =
      fields == 7 && sign == 'Z' && timestamp.size() == static_cast<std::size_t>(read) + 1;
  const bool zoned = fields == 9 && (sign == '+' || sign == '-') &&
                     timestamp.size() == static_cast<std::size_t>(read);
  if (!utc && !zoned) return std::nullopt;
  time.tm_year -= 1900;
  time.tm_mon -= 1;
  const std::int64_t offset = (zone_hours * 60 + zone_minutes) * 60;
  return static_cast<std::int64_t>(::timegm(&time)) - (sign == '-' ? -offset : offset);
}

}  // namespace fieldproof::history
