// What can be wrong with a port that works with user-defined frames. Most faults are a definition
// that differs from what was asked for: a check that is not compared is a variable there, a swap
// that is forgotten is no swap.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "src/plc/emulated_device.hpp"
#include "src/user_frames/frame.hpp"
#include "suites/broken/edge.hpp"
#include "suites/broken/fault.hpp"

namespace fieldproof::user_frames_broken {

/// One fault at work. What is empty is done right.
struct Behaviour {
  std::function<void(user_frames::FrameDefinition& definition)> works_with;
  std::function<void(nlohmann::json& config)> set_to;
  std::function<Bytes(const Bytes& frame)> says;  // instead of `frame`
  std::string deaf_to;                            // an action that changes nothing: "stop"
  broken::Edge edge{};                            // of a server on a network
};

/// The shipped definition of that name, with what the fault makes of it and of the configuration.
Result<user_frames::FrameDefinition> broken_definition(const Behaviour& behaviour,
                                                       std::string_view model,
                                                       nlohmann::json& config);

/// `caught_by` is the id of a case.
using Fault = broken::FaultOf<Behaviour>;

/// All of a port. "none" is no fault and not among them.
const std::vector<Fault>& faults();
/// Those of a server on a network (FEnet EN 7.7.4).
const std::vector<Fault>& server_faults();

std::vector<Fault> check_faults();
std::vector<Fault> frame_faults();
std::vector<Fault> variable_faults();

// How their rows are made.
Behaviour each_frame(std::function<void(user_frames::UserFrame& frame)> edit);
Behaviour each_received(std::function<void(user_frames::UserFrame& frame)> edit);
Behaviour each_sent(std::function<void(user_frames::UserFrame& frame)> edit);
Behaviour each_segment(std::function<void(user_frames::Segment& segment)> edit);
Behaviour each_check(std::function<void(user_frames::Segment& check)> edit);

/// The segment takes any bytes from now on.
void accept_anything(user_frames::Segment& segment);
/// Takes a segment out, or puts one in behind `position`; the check covers the same segments as
/// before.
void remove_segment(user_frames::UserFrame& frame, std::size_t position);
void insert_behind(user_frames::UserFrame& frame, std::size_t position,
                   user_frames::Segment segment);

/// The device of a model's definition with a fault.
Result<std::unique_ptr<plc::EmulatedDevice>> make_broken_port(const Behaviour& behaviour,
                                                              std::string_view model,
                                                              nlohmann::json config);
/// The same on a network.
Result<std::unique_ptr<plc::EmulatedDevice>> make_broken_server(const Behaviour& behaviour,
                                                                std::string_view model,
                                                                nlohmann::json config);

}  // namespace fieldproof::user_frames_broken
