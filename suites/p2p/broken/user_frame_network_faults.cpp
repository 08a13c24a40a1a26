// SEND and RECEIVE blocks of user-defined frames on a network (FEnet EN 7.2, 7.3.3, 7.7.5).
#include "suites/p2p/broken/faults.hpp"

namespace fieldproof::p2p_broken {

using p2p::P2pBlock;
using plc::PlcMemory;

namespace {

using Function = P2pBlock::Function;

void no_receive_blocks(p2p::P2pParameters& parameters) {
  std::erase_if(parameters.blocks,
                [](const P2pBlock& block) { return block.function == Function::receive; });
}

/// A datagram is a piece of a stream: what lacks its end waits for the next one.
Behaviour joins_datagrams() {
  return {.hears_link = [rest = Bytes{}](Burst& burst) mutable {
    if (burst.event != LinkEvent::datagram) return true;
    rest.insert(rest.end(), burst.bytes.begin(), burst.bytes.end());
    if (rest.empty() || rest.back() != '\n') return false;
    burst.bytes = std::exchange(rest, {});
    return true;
  }};
}

/// What lacks its end, or its beginning, is none.
Behaviour whole_segments_alone() {
  return {.hears_link = [](Burst& burst) {
    return burst.event != LinkEvent::data ||
           (burst.bytes.front() == 0x02 && burst.bytes.back() == '\n');
  }};
}

/// Bytes of no frame end the connection.
Behaviour throws_out_for_noise() {
  return {.hears_link = [](Burst& burst) {
    if (burst.event == LinkEvent::data && burst.bytes.front() != 0x02) {
      burst.event = LinkEvent::reset;
      burst.bytes.clear();
    }
    return true;
  }};
}

/// The first request waits until the connection stands, and is forgotten there.
Behaviour connects_without_sending() {
  return {.does = [first = true](std::vector<Burst>& doings) mutable {
    const auto is_bytes = [](const Burst& one) { return one.event == LinkEvent::data; };
    if (first && std::ranges::any_of(doings, is_bytes)) {
      std::erase_if(doings, is_bytes);
      first = false;
    }
  }};
}

void elsewhere(P2pBlock& block) {
  if (block.function != Function::receive) return;
  for (p2p::P2pVariable& variable : block.variables) variable.own = variable.own + 1;
}

/// Where datagrams are due nobody hears a connection.
Behaviour by_tcp() {
  return {.partner = [](p2p::NetworkPartner& partner) { partner.transport = Transport::tcp; },
          .does = [](std::vector<Burst>& doings) { doings.clear(); }};
}

}  // namespace

std::vector<Fault> user_frame_network_faults() {
  return {
      {"net_send_without_last_byte", "the last byte of a frame is not sent",
       spoils([](Bytes& request) { request.pop_back(); }), "user_frames_net/client/tcp", ""},
      {"net_send_on_falling_edge", "SEND goes out when its flag falls",
       trigger(Trigger::falling_edge), "user_frames_net/client/tcp",
       "did not open a connection within"},
      {"net_send_lost_with_connecting", "the frame that opens the connection is lost",
       connects_without_sending, "user_frames_net/client/tcp", "no request within"},
      {"net_send_does_not_reconnect", "a connection that was reset is not opened again",
       does_not_reconnect, "user_frames_net/client/again", ""},
      {"net_send_by_tcp", "a block over UDP opens a connection", by_tcp,
       "user_frames_net/client/udp", "no request within"},
      {"net_receive_not_armed", "RECEIVE takes nothing", works_with(no_receive_blocks),
       "user_frames_net/client/tcp", "%MW199 holds"},
      {"net_receive_saves_nothing", "RECEIVE ends, and saves nothing",
       takes([](const p2p::P2pDriver& good, const P2pBlock& block, const Bytes& frame,
                PlcMemory& memory) {
         PlcMemory other(memory.model());
         return good.take(block, frame, other);
       }),
       "user_frames_net/client/udp", "%MW199 holds"},
      {"net_receive_saves_one_further", "RECEIVE saves one word further", each_block(elsewhere),
       "user_frames_net/client/tcp", "%MW199 holds"},
      {"net_receive_by_segment", "a frame in two segments is none", whole_segments_alone,
       "user_frames_net/client/tcp_pieces", "%MW199 holds"},
      {"net_receive_joins_datagrams", "halves of a frame in two datagrams are one", joins_datagrams,
       "user_frames_net/client/udp_halves", "%MW199 holds"},
      {"net_receive_ends_by_noise", "bytes of no frame end the connection", throws_out_for_noise,
       "user_frames_net/client/noise", ""},
      {"net_receive_not_counted", "a frame that was received is not counted",
       ends([](const Outcome& before, Outcome& now) { now.services = before.services; }),
       "user_frames_net/client/tcp_pieces", "%LD260 holds 00000000"},
      {"net_receive_without_ndr", "a frame that was received does not set NDR",
       ends([](const Outcome&, Outcome& now) { now.ndr = false; }),
       "user_frames_net/client/tcp_pieces", "%LW518 holds 0000"},
  };
}

}  // namespace fieldproof::p2p_broken
