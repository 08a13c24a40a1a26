// What can be wrong with a server: each fault stands in front of a good PLC and spoils one thing.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "suites/broken/fault.hpp"
#include "suites/broken/sendings.hpp"
#include "suites/xgt_cnet/broken/good_plc.hpp"

namespace fieldproof::xgt_cnet_broken {

/// What survives the loss of power, where a fault keeps something that should be lost.
struct Storage {
  std::vector<Bytes> frames;
  std::function<void(const std::vector<Bytes>&)> save;  // may be empty
};

/// One fault at work. Each function may be empty: then the device does the right thing there.
struct Behaviour {
  /// Bytes as they arrive, before frames are looked for.
  std::function<void(Bytes&)> hear;
  /// A complete frame. `together`: it came in one piece with the frame before it.
  std::function<broken::Sendings(const Bytes& frame, bool together, GoodPlc& plc)> answer;
  /// A frame that a silence ended before its tail or BCC: what was heard of it, from ENQ on.
  std::function<broken::Sendings(const Bytes& heard, GoodPlc& plc)> cut_off;
  /// After power on, before anything is heard.
  std::function<void(GoodPlc& plc)> power_on;
};

using MakeBehaviour = std::function<Behaviour(Storage&)>;
/// `caught_by` stands without "xgt_cnet/".
using Fault = broken::FaultOf<MakeBehaviour>;

/// All of them, in the order of the chapters. "none" is no fault and not among them.
const std::vector<Fault>& faults();
/// nullptr when unknown.
const Fault* find_fault(std::string_view name);

// The parts of the table, and how its rows are made.
std::vector<Fault> check_faults();
std::vector<Fault> reply_faults();
std::vector<Fault> data_faults();
std::vector<Fault> limit_faults();
std::vector<Fault> monitor_faults();
std::vector<Fault> line_faults();
std::vector<Fault> narrow_faults();

/// Spoils the reply of the good PLC. The BCC is made right again (`edit_reply`), or left as it is
/// (`spoil_frame`).
MakeBehaviour edit_reply(std::function<void(FrameText& reply, const FrameText& request)> edit);
MakeBehaviour spoil_frame(std::function<void(FrameText& reply, const FrameText& request)> edit);
/// Understands another request than was sent.
MakeBehaviour misread(std::function<Bytes(const Bytes& request, GoodPlc& plc)> read);
/// Answers in its own way.
MakeBehaviour answer_with(std::function<Bytes(const Bytes& request, GoodPlc& plc)> answer);
/// Sends the right reply in its own way; is not asked where the good PLC is silent.
MakeBehaviour send_with(std::function<broken::Sendings(const Bytes& request, Bytes reply)> send);

}  // namespace fieldproof::xgt_cnet_broken
