// What can be wrong with an XGT FEnet server: each fault stands around a good one and spoils one
// thing.
#pragma once

#include <functional>
#include <vector>

#include "src/xgt_fenet/server.hpp"
#include "suites/broken/fault.hpp"
#include "suites/broken/network_server.hpp"

namespace fieldproof::xgt_fenet_broken {

using broken::Bursts;
using broken::Server;
using Makes = broken::Makes<xgt_fenet::ServerConfig>;
using Behaviour = Makes::Behaviour;
using MakeBehaviour = Makes::Make;
using Fault = broken::FaultOf<MakeBehaviour>;

/// All of them.
const std::vector<Fault>& faults();

// The parts of the table.
std::vector<Fault> header_faults();
std::vector<Fault> check_faults();
std::vector<Fault> code_faults();
std::vector<Fault> data_faults();
std::vector<Fault> limit_faults();
std::vector<Fault> stream_faults();
std::vector<Fault> connection_faults();
std::vector<Fault> datagram_faults();
std::vector<Fault> counter_faults();

constexpr auto edits = Makes::edits;
constexpr auto hears = Makes::hears;
constexpr auto acts = Makes::acts;
constexpr auto set_up = Makes::set_up;
constexpr auto shows = Makes::shows;
/// The same of a reply to a request for which `of` holds; the check of the header is made good.
MakeBehaviour edits_if(bool (*of)(const Bytes& reply, const Bytes& request),
                       std::function<void(Bytes& reply)> edit);

// Parts of a frame (FEnet EN 5.2.3, 5.2.5).
constexpr std::size_t plc_info_at = 10, cpu_at = 12, source_at = 13, invoke_at = 14, length_at = 16,
                      position_at = 18, check_at = 19, body_at = 20, command_at = 20, type_at = 22,
                      reserved_at = 24, count_at = 26, status_at = 26, code_at = 28,
                      reply_blocks_at = 28, name_length_at = 28, name_at = 30, data_size_at = 30,
                      data_at = 32;
constexpr unsigned continuous = 0x14;

/// What is no whole header is read as it is.
inline MakeBehaviour misreads(const std::function<Bytes(Bytes request)>& misread) {
  return Makes::misreads([=](Bytes request) {
    return request.size() < body_at ? request : misread(std::move(request));
  });
}

inline unsigned word_at(const Bytes& frame, std::size_t at) {
  return at + 1 < frame.size() ? frame[at] | frame[at + 1] << 8u : 0;
}
inline void put_word(Bytes& frame, std::size_t at, unsigned value) {
  frame.at(at) = static_cast<Byte>(value);
  frame.at(at + 1) = static_cast<Byte>(value >> 8);
}
inline bool is_refusal(const Bytes& reply) { return word_at(reply, status_at) == 0xFFFF; }
inline bool is_read(const Bytes& frame) { return (word_at(frame, command_at) & ~1u) == 0x54; }
inline bool is_write(const Bytes& frame) { return (word_at(frame, command_at) & ~1u) == 0x58; }
inline bool is_continuous(const Bytes& frame) { return word_at(frame, type_at) == continuous; }
/// Of the 19 bytes before the check.
Byte sum_of_header(const Bytes& frame);
/// After a change of the body, or of the header.
void mend(Bytes& frame);
/// The refusal of a request with that code.
Bytes refusal_of(const Bytes& request, unsigned code);

/// Where the name of each block of a request stands, with its length.
struct Name {
  std::size_t at = 0, size = 0;
};
std::vector<Name> names_of(const Bytes& request);
/// The data of each block of a reply or of a write.
std::vector<Name> data_of(const Bytes& frame);

/// A word with its bytes in the other order.
constexpr unsigned swapped(unsigned word) { return (word & 0xFF) << 8 | word >> 8; }

}  // namespace fieldproof::xgt_fenet_broken
