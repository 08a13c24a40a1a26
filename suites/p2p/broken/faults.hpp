// What can be wrong with a P2P client, and the case that finds it.
#pragma once

#include <vector>

#include "src/modbus/frame.hpp"
#include "src/xgt_cnet/codec.hpp"
#include "suites/broken/fault.hpp"
#include "suites/p2p/broken/broken_client.hpp"

namespace fieldproof::p2p_broken {

using MakeBehaviour = std::function<Behaviour()>;
/// `caught_by` is the id of a case; its protocol is the one that the fault is tried with.
using Fault = broken::FaultOf<MakeBehaviour>;

/// All of them. "none" is no fault and not among them.
const std::vector<Fault>& faults();

// The parts of the table.
std::vector<Fault> trigger_faults();
std::vector<Fault> result_faults();
std::vector<Fault> xgt_request_faults();
std::vector<Fault> xgt_reply_faults();
std::vector<Fault> modbus_faults();
std::vector<Fault> ls_bus_faults();
std::vector<Fault> user_frame_faults();
std::vector<Fault> udata_faults();
std::vector<Fault> narrow_faults();
std::vector<Fault> fenet_request_faults();
std::vector<Fault> fenet_reply_faults();
std::vector<Fault> network_faults();
std::vector<Fault> modbus_tcp_request_faults();
std::vector<Fault> modbus_tcp_answer_faults();
std::vector<Fault> modbus_tcp_link_faults();
std::vector<Fault> user_frame_network_faults();

// How their rows are made.
MakeBehaviour trigger(Trigger trigger);
MakeBehaviour timing(std::function<void(p2p::P2pClient::Timing& timing)> edit);
MakeBehaviour deaf_to(std::string action);
/// The engine works with other parameters, or N shows others.
MakeBehaviour works_with(std::function<void(p2p::P2pParameters& parameters)> edit);
MakeBehaviour each_block(std::function<void(p2p::P2pBlock& block)> edit);
MakeBehaviour shows(std::function<void(p2p::P2pParameters& parameters)> edit);
MakeBehaviour shows_blocks(std::function<void(p2p::P2pBlock& block)> edit);
/// Changes what a block shows.
MakeBehaviour ends(std::function<void(const Outcome& before, Outcome& now)> edit);
/// An end with this STATUS leaves no trace.
MakeBehaviour hides(std::uint16_t status);
/// A connection that was lost is not opened again.
Behaviour does_not_reconnect();
/// Asks for another block than it should; the reply is judged against the right one.
MakeBehaviour asks_for(std::function<void(p2p::P2pBlock& block)> edit);
/// Spoils the request.
MakeBehaviour spoils(std::function<void(Bytes& request)> edit);
/// Changes the reply before it is judged.
MakeBehaviour hears(std::function<void(Bytes& reply, const p2p::P2pBlock& block)> edit);
/// Judges, and saves, in its own way; `good` does it right.
MakeBehaviour takes(std::function<std::optional<std::uint16_t>(const p2p::P2pDriver& good,
                                                               const p2p::P2pBlock& block,
                                                               Bytes frame, plc::PlcMemory& memory)>
                        own);
/// After the good driver has saved what was read.
MakeBehaviour after_saving(
    std::function<void(const p2p::P2pBlock& block, plc::PlcMemory& memory)> edit);

}  // namespace fieldproof::p2p_broken
