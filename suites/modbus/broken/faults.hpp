// What can be wrong with a Modbus server: each fault stands in front of a good one and spoils one
// thing.
#pragma once

#include <functional>
#include <vector>

#include "src/modbus/receiver.hpp"
#include "suites/broken/fault.hpp"
#include "suites/broken/sendings.hpp"
#include "suites/modbus/broken/good_modbus.hpp"

namespace fieldproof::modbus_broken {

/// One fault at work. Each function may be empty: then the device does the right thing there.
struct Behaviour {
  /// Bytes as they arrive, before frames are looked for.
  std::function<void(Bytes&)> hear;
  /// How frames are found.
  std::function<std::unique_ptr<modbus::ModbusReceiver>(modbus::ModbusMode mode, Duration gap)>
      receiver;
  /// A frame as it was found, damaged ones too.
  std::function<broken::Sendings(const Bytes& frame, GoodModbus& plc)> answer;
};

using MakeBehaviour = std::function<Behaviour()>;
/// `caught_by` begins with the folder of its protocol, which is also the mode it is tried in.
using Fault = broken::FaultOf<MakeBehaviour>;

/// All of them. "none" is no fault and not among them.
const std::vector<Fault>& faults();
/// nullptr when unknown.
const Fault* find_fault(std::string_view name);

// The parts of the table, and how its rows are made.
std::vector<Fault> frame_faults();
std::vector<Fault> exception_faults();
std::vector<Fault> limit_faults();
std::vector<Fault> data_faults();
std::vector<Fault> line_faults();
std::vector<Fault> narrow_faults();

/// Answers frames in its own way.
MakeBehaviour answer_frame(std::function<Bytes(const Bytes& frame, GoodModbus& plc)> answer);
/// Answers undamaged messages, of whichever station, in its own way.
MakeBehaviour answer_with(std::function<Bytes(const Bytes& request, GoodModbus& plc)> answer);
/// Spoils the reply of the good server; the check is made right again (`edit_reply`), or the frame
/// spoiled (`spoil_frame`).
MakeBehaviour edit_reply(std::function<void(Bytes& reply, const Bytes& request)> edit);
MakeBehaviour spoil_frame(std::function<void(Bytes& frame)> spoil);
/// Understands another request than was sent.
MakeBehaviour misread(std::function<Bytes(Bytes request)> read);
/// Sends the right reply in its own way; is not asked where the good server is silent.
MakeBehaviour send_with(std::function<broken::Sendings(const Bytes& frame, Bytes reply)> send);

}  // namespace fieldproof::modbus_broken
