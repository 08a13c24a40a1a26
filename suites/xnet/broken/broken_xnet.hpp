// PLCs on X-NET and axes that do one thing wrong, for tests of the suite.
#pragma once

#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "src/plc/emulated_device.hpp"
#include "suites/broken/fault.hpp"

namespace fieldproof::xnet_broken {

/// Reads the right device: hex digits at a name.
using Look = std::function<std::string(const std::string& name, std::size_t digits)>;
/// Sets memory of the right device.
using Put = std::function<void(const std::string& name, const std::string& hex)>;

/// What the broken device makes of its configuration, of what it is told, and of memory that is set
/// or looked at; empty: nothing.
struct Behaviour {
  std::function<void(nlohmann::json& config)> config{};
  std::function<std::vector<std::string>(const std::string& action, const Look& look,
                                         const Put& put)>
      act{};
  /// Where a name that is set, or looked at, is found instead.
  std::function<std::string(const std::string&name)> set_name{}, look_name{};
  std::function<std::string(const std::string& name, const std::string& hex)> value{};
  /// What is set instead.
  std::function<std::string(const std::string& name, const std::string& hex)> set_value{};
  /// Whenever time has passed, or something was done to it.
  std::function<void(const Look& look, const Put& put)> after{};
  std::function<void(Trace& trace)> trace{};
  Duration late{};  // actions act so much later
};

using Fault = broken::FaultOf<std::function<Behaviour()>>;
std::vector<Fault> data_faults();
std::vector<Fault> motion_faults();
std::vector<Fault> default_faults();
std::vector<Fault> axis_faults();
std::vector<Fault> bus_faults();
const std::vector<Fault>& faults();

Result<std::unique_ptr<plc::EmulatedDevice>> make_broken_xnet(const Behaviour& behaviour,
                                                              std::string_view model,
                                                              const nlohmann::json& config);

}  // namespace fieldproof::xnet_broken
