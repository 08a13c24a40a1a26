// What a block shows: flags, STATUS and counts in L, its parameters in N (Cnet EN and KO
// Appendix 2.1 (3), 2.2).
#include "suites/p2p/broken/faults.hpp"

namespace fieldproof::p2p_broken {

using p2p::P2pBlock;

namespace {

bool ended_well(const Outcome& now) { return now.status == p2p::p2p_error::none; }

std::uint32_t low_word_only(std::uint32_t before, std::uint32_t now) {
  return (before & 0xFFFF0000) | (now & 0xFFFF);
}
std::uint32_t words_swapped(std::uint32_t count) { return count << 16 | count >> 16; }

MakeBehaviour all_flags_of(std::function<unsigned(unsigned right)> number) {
  return each_block([=](P2pBlock& block) { block.number = number(block.number); });
}

void exchange_function(P2pBlock& block) {
  using Function = P2pBlock::Function;
  block.function = block.function == Function::read ? Function::write : Function::read;
}

}  // namespace

std::vector<Fault> result_faults() {
  return {
      {"services_not_counted", "a normal end is not counted",
       ends([](const Outcome& before, Outcome& now) { now.services = before.services; }),
       "xgt_cnet/client/error/counters", "%LD257 holds 00000000"},
      {"errors_not_counted", "an abnormal end is not counted",
       ends([](const Outcome& before, Outcome& now) { now.errors = before.errors; }),
       "xgt_cnet/client/error/counters", "%LD258 holds 00000000"},
      {"services_counted_twice", "a normal end counts two",
       ends([](const Outcome&, Outcome& now) { now.services += ended_well(now); }),
       "xgt_cnet/client/error/counters", "%LD257 holds 00000002"},
      {"errors_are_services_too", "an abnormal end counts as normal, too",
       ends([](const Outcome&, Outcome& now) { now.services += !ended_well(now); }),
       "xgt_cnet/client/error/counters", "%LD257 holds 00000002"},
      {"services_have_16_bits", "the normal count has no carry into its high word",
       ends([](const Outcome& before, Outcome& now) {
         now.services = low_word_only(before.services, now.services);
       }),
       "xgt_cnet/client/flags/carry/ffff", "%LD257 holds 00000000"},
      {"errors_have_16_bits", "the abnormal count has no carry into its high word",
       ends([](const Outcome& before, Outcome& now) {
         now.errors = low_word_only(before.errors, now.errors);
       }),
       "xgt_cnet/client/flags/carry/ffff", "%LD258 holds 00000000"},
      {"count_stays_at_its_end", "the normal count does not wrap",
       ends([](const Outcome& before, Outcome& now) {
         now.services = std::max(before.services, now.services);
       }),
       "xgt_cnet/client/flags/wrap", "%LD257 holds FFFFFFFF"},
      {"count_words_swapped", "the high word of the normal count comes first",
       ends([](const Outcome& before, Outcome& now) {
         now.services = words_swapped(words_swapped(before.services) + ended_well(now));
       }),
       "xgt_cnet/client/error/counters", "%LD257 holds 00010000"},
      {"counts_swapped", "each count stands in the place of the other",
       ends([](const Outcome& before, Outcome& now) {
         const Outcome right = now;
         now.services = before.services + (right.errors - before.errors);
         now.errors = before.errors + (right.services - before.services);
       }),
       "xgt_cnet/client/error/counters", "%LD257 holds 00000000"},
      {"count_cleared_by_error", "an abnormal end clears the normal count",
       ends([](const Outcome&, Outcome& now) {
         if (!ended_well(now)) now.services = 0;
       }),
       "xgt_cnet/client/error/counters", "%LD257 holds 00000000"},
      {"ndr_kept_on_error", "NDR stays on behind an abnormal end",
       ends([](const Outcome& before, Outcome& now) { now.ndr |= before.ndr; }),
       "xgt_cnet/client/error/counters", "%LW512 holds 0003"},
      {"err_kept_on_success", "ERR stays on behind a normal end",
       ends([](const Outcome& before, Outcome& now) { now.err |= before.err; }),
       "xgt_cnet/client/error/counters", "%LW512 holds 0003"},
      {"ndr_not_set", "a normal end does not show",
       ends([](const Outcome&, Outcome& now) { now.ndr = false; }), "xgt_cnet/client/read_cycle",
       "%LW512 holds 0000"},
      {"ndr_and_err_swapped", "bit 0 is ERR, bit 1 NDR",
       ends([](const Outcome&, Outcome& now) { std::swap(now.ndr, now.err); }),
       "xgt_cnet/client/read_cycle", "%LW512 holds 0002"},
      {"cleared_by_request", "NDR, ERR and STATUS are cleared when the block is asked",
       [] { return Behaviour{.clears_results = true}; }, "xgt_cnet/client/flags/kept_until_the_end",
       "%LW512 holds 0000"},
      {"status_not_set", "an abnormal end leaves STATUS as it is",
       ends([](const Outcome& before, Outcome& now) { now.status = before.status; }),
       "xgt_cnet/client/error/nak/range", "%LW513 holds 0000"},
      {"status_kept_on_success", "a normal end leaves the STATUS of the last error",
       ends([](const Outcome& before, Outcome& now) {
         if (ended_well(now)) now.status = before.status;
       }),
       "xgt_cnet/client/error/counters", "%LW513 holds 000A"},
      {"status_in_high_byte", "STATUS stands in the high byte",
       ends([](const Outcome&, Outcome& now) {
         now.status = static_cast<std::uint16_t>(now.status << 8);
       }),
       "xgt_cnet/client/error/nak/range", "%LW513 holds 0F00"},
      {"every_error_is_a_time_out", "STATUS is 0A whatever is wrong",
       ends([](const Outcome&, Outcome& now) {
         if (!ended_well(now)) now.status = p2p::p2p_error::time_out;
       }),
       "xgt_cnet/client/error/wrong_bcc_first/absent", "%LW513 holds 000A"},
      {"time_out_not_shown", "a request without an answer leaves no trace",
       ends([](const Outcome& before, Outcome& now) {
         if (now.status == p2p::p2p_error::time_out) now = before;
       }),
       "xgt_cnet/client/time_out", "%LW512 holds 0000"},
      {"flags_of_next_block", "the result of a block stands in that of the next",
       all_flags_of([](unsigned right) { return (right + 1) % 32; }),
       "xgt_cnet/client/flags/each_block_its_own", "%LW512 holds 0002"},
      {"flags_of_block_0", "all blocks show their results in block 0",
       all_flags_of([](unsigned) { return 0; }), "xgt_cnet/client/flags/each_block_its_own",
       "%LW512 holds 0002"},
      {"flags_of_parameter_1", "the results of P2P 2 and 3 stand in those of P2P 1",
       works_with([](p2p::P2pParameters& parameters) { parameters.parameter = 1; }),
       "xgt_cnet/client/flags/address/p2b1", "%LW710 holds 0000"},
      {"registers_of_parameter_1", "the parameters of P2P 2 and 3 are shown in those of P2P 1",
       shows([](p2p::P2pParameters& parameters) { parameters.parameter = 1; }),
       "xgt_cnet/client/registers/station/p2b0", "%NW1312 holds 0000"},
      {"registers_of_next_block", "the parameters of a block are shown in those of the next",
       shows_blocks([](P2pBlock& block) { block.number = (block.number + 1) % 32; }),
       "xgt_cnet/client/registers/station/p1b1", "%NW41 holds 0000"},
      {"registers_read_for_save", "read and save areas are shown in each other's place",
       shows_blocks(exchange_function), "xgt_cnet/client/registers/names_of_a_read", "%NW1"},
      {"registers_size_in_elements", "the size of a run is shown in elements, not in bytes",
       shows_blocks([](P2pBlock& block) { block.type = 'B'; }),
       "xgt_cnet/client/registers/names_of_a_read", "%NW1"},
  };
}

}  // namespace fieldproof::p2p_broken
