// P2P over Ethernet (FEnet EN 7.1 to 7.3, A.4): connections, time-out, order, flags.
#include "suites/p2p/broken/faults.hpp"

#include <algorithm>

namespace fieldproof::p2p_broken {

using p2p::P2pBlock;
using Timing = p2p::P2pClient::Timing;

namespace {

Duration halved(Duration right) { return right / 2; }

MakeBehaviour periods(Duration (*period)(Duration right)) {
  return each_block(
      [=](P2pBlock& block) { block.condition.period = period(block.condition.period); });
}

/// Asks again when a block ends with `status`, once, and shows only the second.
MakeBehaviour repeats_after(std::uint16_t status) {
  return [=] {
    return Behaviour{.ends = [=, again = false](const Outcome& before, Outcome& now) mutable {
      again = now.status == status && !again;
      if (again) now = before;
      return again;
    }};
  };
}

Behaviour connects_at_once() {
  return {.does = [first = true](std::vector<Burst>& doings) mutable {
    if (std::exchange(first, false)) {
      Burst opened;
      opened.link = first_own_link;
      opened.event = LinkEvent::opened;
      opened.port = 2004;
      doings.insert(doings.begin(), opened);
      return;
    }
    std::erase_if(doings, [](const Burst& one) {
      return one.event == LinkEvent::opened && one.link == first_own_link;
    });
  }};
}

/// What comes in several pieces is no reply.
Behaviour one_segment_one_frame() {
  return {.hears_link = [](Burst& burst) {
    return burst.event != LinkEvent::data || burst.bytes.size() > 30;
  }};
}

/// Behind the first frame of a segment nothing is looked at.
Behaviour second_frame_lost() {
  return {.hears_link = [](Burst& burst) {
    if (burst.event != LinkEvent::data || burst.bytes.size() < 20) return true;
    const std::size_t size = 20u + burst.bytes[16] + burst.bytes[17] * 256u;
    if (burst.bytes.size() > size) burst.bytes.resize(size);
    return true;
  }};
}

void over_tcp(p2p::NetworkPartner& partner) { partner.transport = Transport::tcp; }

}  // namespace

std::vector<Fault> network_faults() {
  return {
      {"net_connects_at_power_on", "the connection is opened before anything is asked",
       connects_at_once, "xgt_fenet/client/connection/first_use",
       "the device opened the connection 1000.0 ms before"},
      {"net_hangs_up", "the connection is closed after each reply",
       [] { return Behaviour{.hangs_up = true}; }, "xgt_fenet/client/connection/kept", ""},
      {"net_does_not_reconnect", "a connection that was lost is not opened again",
       does_not_reconnect, "xgt_fenet/client/connection/again/rst", ""},
      {"net_keeps_rests", "half a reply of a lost connection stands before the next one",
       [] { return Behaviour{.keeps_rests = true}; },
       "xgt_fenet/client/connection/gone_in_mid_reply/rst/b33", ""},
      {"net_lost_is_no_error", "a request whose connection is lost leaves no trace",
       hides(p2p::p2p_error::send), "xgt_fenet/client/connection/gone_before_reply/rst",
       "%LW512 holds 0000"},
      {"net_lost_is_repeated", "a request whose connection is lost is asked again",
       repeats_after(p2p::p2p_error::send), "xgt_fenet/client/connection/gone_before_reply/rst",
       ""},
      {"net_one_connection", "all channels share a connection",
       each_block([](P2pBlock& block) { block.channel = 1; }),
       "xgt_fenet/client/connection/two_channels", ""},
      {"net_channels_alike", "all channels have the settings of the module",
       works_with([](p2p::P2pParameters& parameters) { parameters.channels.clear(); }),
       "xgt_fenet/client/channels/ports",
       "the device opened a connection to TCP 2004; 4000 is due"},
      {"net_port_of_the_module", "every channel asks at port 2004, whatever it speaks",
       [] {
         return Behaviour{.partner = [](p2p::NetworkPartner& partner) { partner.port = 2004; }};
       },
       "xgt_fenet/client/channels/xgt_and_modbus",
       "the device opened a connection to TCP 2004; 502 is due"},
      {"net_two_at_once", "a block does not wait for the reply to another",
       [] { return Behaviour{.all_at_once = true}; }, "xgt_fenet/client/connection/one_at_a_time",
       ""},
      {"net_power_cycle_keeps", "a connection is used on when the power was gone",
       deaf_to("power_cycle"), "xgt_fenet/client/connection/power_cycle", ""},
      {"net_segment_is_frame", "a reply in several segments is none", one_segment_one_frame,
       "xgt_fenet/client/errors/pieces/two", "%MW119 holds 135724689BDF86427531FDB9"},
      {"net_second_frame_lost", "of two replies in a segment the second is lost", second_frame_lost,
       "xgt_fenet/client/errors/wrong_invoke_same_segment",
       "%MW119 holds 135724689BDF86427531FDB9"},
      {"net_tcp_for_udp", "a channel of UDP opens a connection",
       [] { return Behaviour{.partner = over_tcp}; }, "xgt_fenet/client/udp/read",
       "no request within"},
      {"net_time_out_short", "3 s instead of 5 s",
       timing([](Timing& timing) { timing.time_out = 3s; }), "xgt_fenet/client/errors/slow",
       "%MW119 holds 135724689BDF86427531FDB9"},
      {"net_time_out_long", "8 s instead of 5 s",
       timing([](Timing& timing) { timing.time_out = 8s; }), "xgt_fenet/client/errors/no_reply",
       "%LW512 holds 0000"},
      {"net_retry", "a request without a reply is asked again",
       repeats_after(p2p::p2p_error::time_out), "xgt_fenet/client/errors/no_reply",
       "where silence is due"},
      {"net_retry_udp", "a datagram without a reply is sent again",
       repeats_after(p2p::p2p_error::time_out), "xgt_fenet/client/udp/no_reply",
       "where silence is due"},
      {"net_time_out_not_shown", "a request without a reply leaves no trace",
       hides(p2p::p2p_error::time_out), "xgt_fenet/client/errors/no_reply", "%LW512 holds 0000"},
      {"net_late_saved", "a reply that comes after the time-out is saved",
       [] { return Behaviour{.saves_late = true}; }, "xgt_fenet/client/errors/late",
       "%MW119 holds 13576BCD9BDF86427531FDB9"},
      {"net_second_reply_saved", "a second reply to a request is saved, too",
       [] {
         return Behaviour{.hears_link = [](Burst& burst) {
           const std::size_t half = burst.bytes.size() / 2;
           if (half == 34) burst.bytes.erase(burst.bytes.begin(), burst.bytes.begin() + 34);
           return true;
         }};
       },
       "xgt_fenet/client/errors/reply_twice", "%MW119 holds 13576BCD9BDF86427531FDB9"},
      {"net_ndr_and_err_swapped", "bit 0 is ERR, bit 1 NDR",
       ends([](const Outcome&, Outcome& now) { std::swap(now.ndr, now.err); }),
       "xgt_fenet/client/read/single/word", "%LW512 holds 0002"},
      {"net_status_kept", "a normal end leaves the STATUS of the last error",
       ends([](const Outcome& before, Outcome& now) {
         if (now.status == 0) now.status = before.status;
       }),
       "xgt_fenet/client/errors/nak_of_write", "%LW513 holds 0003"},
      {"net_services_not_counted", "a normal end is not counted",
       ends([](const Outcome& before, Outcome& now) { now.services = before.services; }),
       "xgt_fenet/client/read/single/word", "%LD257 holds 00000000"},
      {"net_errors_not_counted", "an abnormal end is not counted",
       ends([](const Outcome& before, Outcome& now) { now.errors = before.errors; }),
       "xgt_fenet/client/errors/nak/c0004", "%LD258 holds 00000000"},
      {"net_flags_of_next_block", "the result of a block stands in that of the next",
       each_block([](P2pBlock& block) { block.number = (block.number + 1) % 32; }),
       "xgt_fenet/client/limits/flags/p1b1", "%LW518 holds 0000"},
      {"net_flags_of_parameter_1", "the results of P2P 2 stand in those of P2P 1",
       works_with([](p2p::P2pParameters& parameters) { parameters.parameter = 1; }),
       "xgt_fenet/client/limits/flags/p2b0", "%LW704 holds 0000"},
      {"net_shows_the_station", "N shows a station where the channel belongs",
       shows([](p2p::P2pParameters& parameters) { parameters.network = false; }),
       "xgt_fenet/client/limits/registers/p1b0", "%NW0 holds"},
      {"net_registers_of_parameter_1", "the parameters of P2P 2 are shown in those of P2P 1",
       shows([](p2p::P2pParameters& parameters) { parameters.parameter = 1; }),
       "xgt_fenet/client/limits/registers/p2b0", "%NW1312 holds 0000"},
      {"net_names_not_shown", "N shows no names",
       shows_blocks([](P2pBlock& block) { block.variables.clear(); }),
       "xgt_fenet/client/limits/names_in_n", "%NW1 holds"},
      {"net_second_name_not_shown", "N shows the first area alone",
       shows_blocks([](P2pBlock& block) { block.variables.resize(1); }),
       "xgt_fenet/client/limits/names_in_n", "%NW1 holds"},
      {"net_third_name_shown", "N shows the last area in the places of those that are not used",
       shows_blocks([](P2pBlock& block) { block.variables.push_back(block.variables.back()); }),
       "xgt_fenet/client/limits/names_in_n", "%NW11 holds"},
      {"net_size_in_elements", "N shows the sizes in elements",
       shows_blocks([](P2pBlock& block) { block.type = 'B'; }),
       "xgt_fenet/client/limits/names_in_n", "%NW1 holds"},
      {"net_read_and_save_swapped", "N shows what is read where what is saved belongs",
       shows_blocks([](P2pBlock& block) { block.function = P2pBlock::Function::write; }),
       "xgt_fenet/client/limits/names_in_n", "%NW1 holds"},
      {"net_shows_16_blocks", "N shows the blocks below 16 alone",
       shows([](p2p::P2pParameters& parameters) {
         std::erase_if(parameters.blocks, [](const P2pBlock& one) { return one.number >= 16; });
       }),
       "xgt_fenet/client/limits/registers/p1b31", "%NW1271 holds 0000"},
      {"net_edge_missed", "every second rising edge is not seen",
       trigger(Trigger::every_second_edge), "xgt_fenet/client/schedule/edge", "no request within"},
      {"net_level_for_edge", "a flag that stays on asks again and again", trigger(Trigger::level),
       "xgt_fenet/client/schedule/edge", "where silence is due"},
      {"net_both_edges", "the block fires when its flag falls, too", trigger(Trigger::both_edges),
       "xgt_fenet/client/schedule/edge", "where silence is due"},
      {"net_edge_queued", "an edge while the block is under way is served behind it",
       trigger(Trigger::queued_edges), "xgt_fenet/client/schedule/edge_lost_while_busy",
       "where silence is due"},
      {"net_clocks_twice_as_fast", "clocks have half their period", periods(halved),
       "xgt_fenet/client/schedule/f92", "came after 100.0 ms instead of every 200.0 ms"},
      {"net_blocks_in_reverse", "of the blocks that have fired the last is asked first",
       works_with([](p2p::P2pParameters& parameters) { std::ranges::reverse(parameters.blocks); }),
       "xgt_fenet/client/schedule/block_order", "expected"},
      {"net_channels_wait", "a channel waits for the reply of another one",
       each_block([](P2pBlock& block) { block.channel = 1; }),
       "xgt_fenet/client/schedule/busy_channel", ""},
      {"net_asks_in_stop", "STOP does not stop the client", deaf_to("stop"),
       "xgt_fenet/client/schedule/stop", "where silence is due"},
      {"net_asks_without_link", "a link that is not enabled does not stop the client",
       deaf_to("link off"), "xgt_fenet/client/schedule/link_off", "%MW119 holds 13576BCD"},
  };
}

}  // namespace fieldproof::p2p_broken
