// Stations of the high-speed link that do one thing wrong, for tests of the suite.
#pragma once

#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "src/plc/emulated_device.hpp"
#include "suites/broken/fault.hpp"

namespace fieldproof::hs_link_broken {

/// What is seen of the right device: two digits of a bit of L.
using Look = std::function<std::string(unsigned bit)>;

/// What the broken device makes of its configuration, of a bit of L, of an action, of a counter;
/// empty: nothing.
struct Behaviour {
  std::function<void(nlohmann::json& config)> config{};
  std::function<std::string(unsigned bit, const Look& look)> bit{};
  std::function<std::vector<std::string>(const std::string& action)> act{};
  /// The counter that is shown instead of "@sent" or another.
  std::function<std::string(std::string_view name)> show{};
};

using Fault = broken::FaultOf<std::function<Behaviour()>>;
const std::vector<Fault>& faults();

Result<std::unique_ptr<plc::EmulatedDevice>> make_broken_network(const Behaviour& behaviour,
                                                                 std::string_view model,
                                                                 const nlohmann::json& config);

}  // namespace fieldproof::hs_link_broken
