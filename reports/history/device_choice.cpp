#include "reports/history/device_choice.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace fieldproof::history {

std::vector<std::string> devices_of(const std::vector<RunEntry>& runs) {
  std::vector<std::string> devices;
  for (auto run = runs.rbegin(); run != runs.rend(); ++run)
    if (std::ranges::find(devices, run->device) == devices.end()) devices.push_back(run->device);
  std::ranges::reverse(devices);
  return devices;
}

Result<std::string> find_device(const std::vector<RunEntry>& runs, const std::string& text) {
  const std::vector<std::string> devices = devices_of(runs);
  std::vector<std::string> fitting;
  for (const std::string& device : devices) {
    if (device == text) return device;
    if (device.find(text) != std::string::npos) fitting.push_back(device);
  }
  if (fitting.size() == 1) return fitting.front();
  return fail(fmt::format("'{}' is {} of this history; it has:\n  {}", text,
                          fitting.empty() ? "no device" : "a part of several devices",
                          fmt::join(fitting.empty() ? devices : fitting, "\n  ")));
}

}  // namespace fieldproof::history
