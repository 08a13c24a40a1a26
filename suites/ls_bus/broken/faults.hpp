// What can be wrong with an inverter: each fault stands in front of a good one and spoils one
// thing.
#pragma once

#include <functional>
#include <string_view>
#include <vector>

#include "suites/broken/fault.hpp"
#include "suites/broken/sendings.hpp"
#include "suites/ls_bus/broken/good_inverter.hpp"

namespace fieldproof::ls_bus_broken {

/// One fault at work. Each function may be empty: then the device does the right thing there.
struct Behaviour {
  /// Bytes as they arrive, before frames are looked for.
  std::function<void(Bytes&)> hear;
  /// A complete frame. `together`: it came in one piece with the frame before it.
  std::function<broken::Sendings(const Bytes& frame, bool together, GoodInverter& inverter)> answer;
};

using MakeBehaviour = std::function<Behaviour()>;
/// `caught_by` stands without "ls_bus/".
using Fault = broken::FaultOf<MakeBehaviour>;

/// All of them but those of `back_door_faults`. "none" is no fault and not among them.
const std::vector<Fault>& faults();
/// Those whose cases set parameters that are read only, or the order of writes: only a back door
/// can do that.
const std::vector<Fault>& back_door_faults();
/// Of either table; nullptr when unknown.
const Fault* find_fault(std::string_view name);

// The parts of the table, and how its rows are made.
std::vector<Fault> check_faults();
std::vector<Fault> reply_faults();
std::vector<Fault> request_faults();
std::vector<Fault> line_faults();
std::vector<Fault> narrow_faults();

/// Spoils the reply of the good inverter. The sum is made right again (`edit_reply`), or left as it
/// is (`spoil_frame`).
MakeBehaviour edit_reply(std::function<void(FrameText& reply, const FrameText& request)> edit);
MakeBehaviour spoil_frame(std::function<void(FrameText& reply, const FrameText& request)> edit);
/// Understands another request than was sent; its sum is made right where that of the request was.
MakeBehaviour misread(std::function<void(FrameText& request)> read);
/// Answers requests with a right sum in its own way, where the good inverter is not silent. `right`
/// is its reply.
MakeBehaviour answer_with(std::function<FrameText(const FrameText& request, const FrameText& right,
                                                  GoodInverter& inverter)>
                              answer);
/// Sends the right reply in its own way; is not asked where the good inverter is silent.
MakeBehaviour send_with(std::function<broken::Sendings(const Bytes& request, Bytes reply)> send);

}  // namespace fieldproof::ls_bus_broken
