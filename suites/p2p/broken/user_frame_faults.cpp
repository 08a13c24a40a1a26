// SEND and RECEIVE blocks of user-defined frames (Cnet EN 6.2.4, 10.4; Cnet KO 6.5, 11.4).
#include "suites/p2p/broken/faults.hpp"

namespace fieldproof::p2p_broken {

using p2p::P2pBlock;
using plc::PlcMemory;

namespace {

using Function = P2pBlock::Function;

void without_receive(p2p::P2pParameters& parameters) {
  std::erase_if(parameters.blocks,
                [](const P2pBlock& block) { return block.function == Function::receive; });
}

/// RECEIVE takes a frame only behind a SEND.
Behaviour only_when_asked() {
  const auto asked = std::make_shared<bool>(false);
  return {.asks =
              [=](p2p::P2pDriver& good, const P2pBlock& block, const PlcMemory& memory) {
                *asked = true;
                return good.request(block, memory);
              },
          .takes = [=](const p2p::P2pDriver& good, const P2pBlock& block, const Bytes& frame,
                       PlcMemory& memory) -> std::optional<std::uint16_t> {
            if (!*asked) return std::nullopt;
            const auto error = good.take(block, frame, memory);
            if (error) *asked = false;
            return error;
          }};
}

/// RECEIVE takes one frame, then no other.
Behaviour only_once() {
  return {.takes = [done = std::make_shared<std::vector<unsigned>>()](
                       const p2p::P2pDriver& good, const P2pBlock& block, const Bytes& frame,
                       PlcMemory& memory) -> std::optional<std::uint16_t> {
    if (std::ranges::find(*done, block.number) != done->end()) return std::nullopt;
    const auto error = good.take(block, frame, memory);
    if (error) done->push_back(block.number);
    return error;
  }};
}

/// The data land in the places of the next variable.
void rotate_places(P2pBlock& block) {
  if (block.function != Function::receive || block.variables.size() < 2) return;
  const plc::DeviceAddress first = block.variables.front().own;
  for (std::size_t i = 0; i + 1 < block.variables.size(); ++i)
    block.variables[i].own = block.variables[i + 1].own;
  block.variables.back().own = first;
}

std::optional<std::uint16_t> count_only(const p2p::P2pDriver& good, const P2pBlock& block,
                                        const Bytes& frame, PlcMemory& memory) {
  PlcMemory elsewhere(memory.model());
  return good.take(block, frame, elsewhere);
}

}  // namespace

std::vector<Fault> user_frame_faults() {
  return {
      {"receive_not_armed", "RECEIVE blocks take nothing", works_with(without_receive),
       "user_frames/client_px7/receive_alone", "%MW199 holds 5A6B1A2B3C4D7C8D"},
      {"receive_only_when_asked", "RECEIVE takes a frame only behind a SEND", only_when_asked,
       "user_frames/client_px7/not_asked", "%MW199 holds 5A6B1A2B3C4D7C8D"},
      {"receive_once", "RECEIVE takes one frame and no other", only_once,
       "user_frames/client_px7/receive_alone", "%LD272 holds 00000001"},
      {"receive_saves_nothing", "RECEIVE ends, and saves nothing", takes(count_only),
       "user_frames/client_px7/receive_alone", "%MW199 holds 5A6B1A2B3C4D7C8D"},
      {"receive_variables_rotated", "the variables of a RECEIVE are saved in each other's places",
       each_block(rotate_places), "user_frames/client_variables/four_received",
       "%MW040 holds 6869"},
      {"send_on_level", "SEND goes out again while its flag is on", trigger(Trigger::level),
       "user_frames/client_px7/edge", "where silence is due"},
      {"send_on_falling_edge", "SEND goes out when its flag falls", trigger(Trigger::falling_edge),
       "user_frames/client_px7/edge", "no request within"},
      {"send_without_last_byte", "the last byte of a frame is not sent",
       spoils([](Bytes& request) { request.pop_back(); }), "user_frames/client_px7/example",
       "rest: expected nothing, got CR"},
      {"send_twice_as_often", "F93 sends every 500 ms",
       each_block([](P2pBlock& block) { block.condition.period /= 2; }),
       "user_frames/client_px7/period/f93", "came after 500.0 ms instead of every 1000.0 ms"},
      {"send_one_byte_less", "SIZE1 is taken one byte too small",
       [] {
         return Behaviour{
             .asks = [](P2pDriver& good, const P2pBlock& block, const plc::PlcMemory& memory) {
               P2pBlock less = block;
               less.size -= less.size > 1;
               const bool sendable = static_cast<bool>(good.check(less, memory.model()));
               return good.request(sendable ? less : block, memory);
             }};
       },
       "user_frames/client_variables/size_4", "data: expected '5ABC1D2E', got '5ABC1D'"},
      {"send_in_stop", "STOP does not stop SEND and RECEIVE", deaf_to("stop"),
       "user_frames/client_px7/stop", "where silence is due"},
      {"send_without_link", "a link that is not enabled does not stop SEND and RECEIVE",
       deaf_to("link off"), "user_frames/client_px7/link", "where silence is due"},
      {"receive_counts_in_next_block", "a block shows its result in that of the next",
       each_block([](P2pBlock& block) { block.number = (block.number + 1) % 32; }),
       "user_frames/client_xgt_write/ack", "%LW512 holds 0000"},
      {"sends_in_reverse", "of two SEND blocks on one flag the last goes first",
       works_with([](p2p::P2pParameters& parameters) { std::ranges::reverse(parameters.blocks); }),
       "user_frames/client_xgt_write/two_sends", "station: expected '00', got '01'"},
  };
}

}  // namespace fieldproof::p2p_broken
