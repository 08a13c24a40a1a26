// What can be wrong with a Modbus TCP server: each fault stands around a good one and spoils one
// thing.
#pragma once

#include <functional>
#include <map>
#include <vector>

#include "src/modbus/tcp_server.hpp"
#include "suites/broken/fault.hpp"
#include "suites/broken/network_server.hpp"

namespace fieldproof::modbus_tcp_broken {

using broken::Bursts;
using broken::Server;
using Makes = broken::Makes<modbus::TcpServerConfig>;
using Behaviour = Makes::Behaviour;
using MakeBehaviour = Makes::Make;
using Fault = broken::FaultOf<MakeBehaviour>;

/// All of them.
const std::vector<Fault>& faults();

// The parts of the table.
std::vector<Fault> header_faults();
std::vector<Fault> stream_faults();
std::vector<Fault> connection_faults();
std::vector<Fault> data_faults();
std::vector<Fault> xinje_faults();

constexpr auto edits = Makes::edits;
constexpr auto misreads = Makes::misreads;
constexpr auto hears = Makes::hears;
constexpr auto acts = Makes::acts;
constexpr auto set_up = Makes::set_up;

// Parts of a frame (FEnet EN 5.3.3).
constexpr std::size_t protocol_at = 2, length_at = 4, unit_at = 6, function_at = 7, address_at = 8,
                      count_at = 10, pdu_at = 7;
inline unsigned word_at(const Bytes& frame, std::size_t at) {
  return at + 1 < frame.size() ? frame[at] * 256u + frame[at + 1] : 0;
}
inline void put_word(Bytes& frame, std::size_t at, unsigned value) {
  frame[at] = static_cast<Byte>(value >> 8);
  frame[at + 1] = static_cast<Byte>(value);
}
inline Byte function_of(const Bytes& frame) {
  return frame.size() > function_at ? frame[function_at] : Byte{};
}
inline bool is_exception(const Bytes& reply) { return (function_of(reply) & 0x80) != 0; }
/// After a change of the PDU.
inline void set_length(Bytes& frame) {
  put_word(frame, length_at, static_cast<unsigned>(frame.size() - unit_at));
}
/// The exception to a request.
Bytes exception_to(const Bytes& request, Byte code);

}  // namespace fieldproof::modbus_tcp_broken
