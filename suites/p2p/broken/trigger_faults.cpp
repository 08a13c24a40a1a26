// When a block is asked: edges, clocks, order, RUN and link, time-out (Cnet EN and KO 6.2.4, 4.3).
#include "suites/p2p/broken/faults.hpp"

namespace fieldproof::p2p_broken {

using p2p::P2pBlock;

namespace {

using Timing = p2p::P2pClient::Timing;

MakeBehaviour clocks(std::function<Duration(Duration right)> period) {
  return each_block([=](P2pBlock& block) {
    if (block.condition.period != Duration::zero())
      block.condition.period = period(block.condition.period);
  });
}

/// Asks once more after the first time-out, and shows only the second.
Behaviour retry() {
  return {.ends = [retried = false](const Outcome& before, Outcome& now) mutable {
    retried = now.status == p2p::p2p_error::time_out && !retried;
    if (retried) now = before;
    return retried;
  }};
}

/// Asks nothing after three time-outs in a row.
Behaviour gives_up() {
  const auto time_outs = std::make_shared<int>(0);
  return {.asks = [=](p2p::P2pDriver& good, const P2pBlock& block,
                      const plc::PlcMemory& memory) -> Result<Bytes> {
            if (*time_outs >= 3) return fail("the partner is taken for dead");
            return good.request(block, memory);
          },
          .ends =
              [=](const Outcome&, Outcome& now) {
                *time_outs = now.status == p2p::p2p_error::time_out ? *time_outs + 1 : 0;
                return false;
              }};
}

void one_block_a_flag(p2p::P2pParameters& parameters) {
  std::vector<P2pBlock> first;
  for (const P2pBlock& block : parameters.blocks) {
    const auto same = [&](const P2pBlock& other) {
      return other.condition.flag == block.condition.flag &&
             other.condition.period == block.condition.period;
    };
    if (std::ranges::none_of(first, same)) first.push_back(block);
  }
  parameters.blocks = first;
}

}  // namespace

std::vector<Fault> trigger_faults() {
  return {
      {"edge_missed", "every second rising edge is not seen", trigger(Trigger::every_second_edge),
       "xgt_cnet/client/error/counters", "no request within"},
      {"level_for_edge", "a flag that stays on asks again and again", trigger(Trigger::level),
       "xgt_cnet/client/read_cycle", "where silence is due"},
      {"falling_edge", "the block fires when its flag falls", trigger(Trigger::falling_edge),
       "xgt_cnet/client/read_cycle", "no request within"},
      {"both_edges", "the block fires when its flag rises and when it falls",
       trigger(Trigger::both_edges), "xgt_cnet/client/error/counters", "where silence is due"},
      {"edge_queued_while_busy", "an edge while the block is under way is served behind it",
       trigger(Trigger::queued_edges), "xgt_cnet/client/schedule/edge_lost_while_busy",
       "where silence is due"},
      {"fires_on_run", "a flag that was on before RUN counts as risen", trigger(Trigger::held_flag),
       "xgt_cnet/client/schedule/flag_on_before_run", "where silence is due"},
      {"fall_gives_up", "a flag that falls while its block is under way gives it up",
       trigger(Trigger::aborted_by_fall), "xgt_cnet/client/schedule/flag_falls_while_busy",
       "%MW119 holds 135724689BDF86427531FDB9"},
      {"f92_every_100_ms", "clocks have half their period",
       clocks([](Duration right) { return right / 2; }), "xgt_cnet/client/schedule/f92",
       "came after 100.0 ms instead of every 200.0 ms"},
      {"clocks_half_as_fast", "clocks have twice their period",
       clocks([](Duration right) { return 2 * right; }), "xgt_cnet/client/schedule/f90",
       "came after 40.0 ms instead of every 20.0 ms"},
      {"f93_as_f92", "the clock of one second has 200 ms",
       clocks([](Duration right) { return std::min<Duration>(right, 200ms); }),
       "xgt_cnet/client/schedule/f93", "came after 200.0 ms instead of every 1000.0 ms"},
      {"blocks_in_reverse", "of the blocks that have fired the last is asked first",
       works_with([](p2p::P2pParameters& parameters) { std::ranges::reverse(parameters.blocks); }),
       "xgt_cnet/client/schedule/block_order", "station: expected 03, got 07"},
      {"one_block_a_flag", "of several blocks on one flag only the first is asked",
       works_with(one_block_a_flag), "xgt_cnet/client/schedule/block_order", "no request within"},
      {"two_at_once", "a block does not wait for the reply to another",
       [] { return Behaviour{.all_at_once = true}; },
       "xgt_cnet/client/schedule/edge_of_another_block_waits", "where silence is due"},
      {"blocks_of_both_channels", "the blocks of the other channel are asked on this line",
       each_block([](P2pBlock& block) { block.channel = block.channel == 1 ? 2 : 1; }),
       "xgt_cnet/client/schedule/channel/one", "station: expected 03, got 02"},
      {"asks_in_stop", "STOP does not stop the client", deaf_to("stop"),
       "xgt_cnet/client/schedule/stop_with_clock", "where silence is due"},
      {"asks_without_link", "a link that is not enabled does not stop the client",
       deaf_to("link off"), "xgt_cnet/client/schedule/link_off", "where silence is due"},
      {"power_cycle_keeps_request", "a request that is under way survives power off",
       deaf_to("power_cycle"), "xgt_cnet/client/schedule/power_cycle_while_busy",
       "%MW119 holds 13575ABC9BDF86427531FDB9"},
      {"time_out_short", "n x 100 ms instead of (n + 1) x 100 ms",
       timing([](Timing& timing) { timing.time_out -= 100ms; }),
       "xgt_cnet/client/time_out/exact/n1", "%LW512 holds 0002"},
      {"time_out_long", "(n + 2) x 100 ms instead of (n + 1) x 100 ms",
       timing([](Timing& timing) { timing.time_out += 100ms; }),
       "xgt_cnet/client/time_out/exact/n1", "%LW512 holds 0000"},
      {"time_out_10_ms_short", "the time-out is 10 ms too short",
       timing([](Timing& timing) { timing.time_out -= 10ms; }), "xgt_cnet/client/time_out/exact/n1",
       "%LW512 holds 0002"},
      {"time_out_10_ms_long", "the time-out is 10 ms too long",
       timing([](Timing& timing) { timing.time_out += 10ms; }), "xgt_cnet/client/time_out/exact/n1",
       "%LW512 holds 0000"},
      {"time_out_fixed", "the time-out is one second whatever is set",
       timing([](Timing& timing) { timing.time_out = 1s; }), "xgt_cnet/client/time_out/exact/n1",
       "%LW512 holds 0000"},
      {"time_out_from_first_byte", "the time-out runs from the first byte sent",
       timing([](Timing& timing) { timing.character_time = {}; }),
       "xgt_cnet/client/time_out/from_the_last_byte", "%LW512 holds 0002"},
      {"retry", "a request without an answer is sent again, which no manual has", retry,
       "xgt_cnet/client/time_out", "where silence is due"},
      {"gives_up", "after three time-outs nothing is asked any more", gives_up,
       "xgt_cnet/client/time_out/no_memory_of_time_outs",
       "came after 600.0 ms instead of every 400.0 ms"},
      {"no_delay", "the delay time of RS-485 is not kept before a request",
       timing([](Timing& timing) { timing.delay = {}; }),
       "xgt_cnet/client/schedule/delay_before_request", "where silence is due"},
      {"delay_on_rs232", "a delay of 600 ms before each request on RS-232",
       timing([](Timing& timing) { timing.delay = 600ms; }),
       "xgt_cnet/client/schedule/delay_of_rs232_is_none",
       "late request: 600.0 ms after what it follows, the limit is 500"},
      {"late_reply_for_next", "a reply that came too late is taken for that of the next request",
       [] { return Behaviour{.keeps_late_replies = true}; },
       "xgt_cnet/client/time_out/unasked_answer", "%MW119 holds 13575ABC9BDF86427531FDB9"},
  };
}

}  // namespace fieldproof::p2p_broken
