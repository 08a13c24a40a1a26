// An Ethernet module that mails, with one known fault, so that the suite can be shown to find it:
// a good one, with the fault in what it is set to, hears, says, or shows.
#pragma once

#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "src/base/burst.hpp"
#include "src/base/result.hpp"
#include "src/plc/emulated_device.hpp"

namespace fieldproof::email_broken {

using Bursts = std::vector<Burst>;

/// What a fault may look at and do.
struct Module {
  plc::EmulatedDevice& plc;  // the good one: memory and actions
  std::string last_said{};   // before what is looked at: "DATA\r\n"
  bool run = true, link = true;
  Time now{};
};

/// One fault at work. What is empty is done right.
struct Behaviour {
  std::function<void(nlohmann::json& config)> works_with{};
  /// Changes what the server says before the module hears it; "": it does not.
  std::function<std::string(std::string text, Module& module)> hears{};
  /// Changes what the module says; "": nothing.
  std::function<std::string(std::string text, Module& module)> says{};
  /// Changes what goes out at one moment.
  std::function<void(Bursts& does, Module& module)> acts{};
  /// After anything has happened: changes what the module shows.
  std::function<void(Module& module)> shows{};
  std::function<bool(std::string_view action, const Module& module)> ignores{};
};

/// `config` as of the good device. Errors are those of its configuration.
Result<std::unique_ptr<plc::EmulatedDevice>> make_broken_module(const Behaviour& behaviour,
                                                                std::string_view model,
                                                                const nlohmann::json& config);

}  // namespace fieldproof::email_broken
