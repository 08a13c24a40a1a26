// What can be wrong with a PLC around its services: how its lines are set, what its services share,
// what it counts, what its frame monitor shows, how its modem answers.
#pragma once

#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "harness/protocol.hpp"
#include "harness/vectors/case.hpp"
#include "suites/broken/edge.hpp"
#include "suites/broken/fault.hpp"

namespace fieldproof::services_broken {

/// One fault at work. What is empty is done right.
struct Behaviour {
  /// Changes given.config, with what it says of the line.
  std::function<void(nlohmann::json& config)> set_up{};
  /// Changes what the device takes it for; the case stays right.
  std::function<void(nlohmann::json& config)> takes{};
  broken::Edge edge{};
  bool memory_apart = false;  // the services beside the main one have a memory of their own
};

using MakeBehaviour = std::function<Behaviour()>;
using Fault = broken::FaultOf<MakeBehaviour>;

/// All of them. "none" is no fault and not among them.
const std::vector<Fault>& faults();

// The parts of the table.
std::vector<Fault> line_faults();
std::vector<Fault> counter_faults();
std::vector<Fault> monitor_faults();
std::vector<Fault> shared_faults();
std::vector<Fault> modem_faults();

// How their rows are made.
MakeBehaviour edge(broken::Edge edge);
/// What is seen at a name of the back door is `to` where it is one of `from`.
MakeBehaviour shows(std::string name, std::vector<std::string> from, std::string to);

/// Is a case about any of it?
bool concerns(const vectors::Case& one);

/// The case as it is with that fault.
vectors::Case set_up(const Behaviour& behaviour, vectors::Case one);
/// The device of a protocol, and of a model, empty: its first.
Result<std::unique_ptr<plc::EmulatedDevice>> make_broken_plc(const Behaviour& behaviour,
                                                             const harness::Protocol& protocol,
                                                             std::string_view model,
                                                             const nlohmann::json& config);

}  // namespace fieldproof::services_broken
