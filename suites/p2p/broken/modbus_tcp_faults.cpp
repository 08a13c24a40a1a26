// The Modbus TCP client of an Ethernet module (FEnet EN 5.3, 7.2, 7.3.2, 7.6): the header of what
// it asks, the function of each table, and what it makes of an answer.
#include "suites/p2p/broken/faults.hpp"

#include <memory>

#include "src/modbus/mbap.hpp"

namespace fieldproof::p2p_broken {

using modbus::mbap_prefix;
using p2p::P2pBlock;
using p2p::P2pDriver;
using plc::PlcMemory;

namespace {

enum : std::size_t { protocol_at = 2, length_at = 4, unit_at = mbap_prefix, pdu_at = 7 };

constexpr Byte bit_by_05 = 5, word_by_06 = 6, bits_by_0f = 0x0F, words_by_10 = 0x10;

unsigned number_at(const Bytes& bytes, std::size_t at) {
  return static_cast<unsigned>(bytes.at(at) << 8 | bytes.at(at + 1));
}

void set_number(Bytes& bytes, std::size_t at, unsigned value) {
  bytes.at(at) = static_cast<Byte>(value >> 8);
  bytes.at(at + 1) = static_cast<Byte>(value);
}

/// Sends another PDU; the length follows.
MakeBehaviour sends_pdu(std::function<void(Bytes& pdu)> edit) {
  return spoils([=](Bytes& frame) {
    Bytes pdu(frame.begin() + pdu_at, frame.end());
    edit(pdu);
    frame =
        modbus::encode_mbap(static_cast<std::uint16_t>(number_at(frame, 0)), frame[unit_at], pdu);
  });
}

MakeBehaviour function_by(Byte right, Byte wrong) {
  return sends_pdu([=](Bytes& pdu) {
    if (pdu[0] == right) pdu[0] = wrong;
  });
}

MakeBehaviour header_word(std::size_t at, std::function<unsigned(unsigned right)> wrong) {
  return spoils([=](Bytes& frame) { set_number(frame, at, wrong(number_at(frame, at))); });
}

/// Takes another answer for that which came whole.
MakeBehaviour answer(std::function<void(Bytes& frame, const P2pBlock& block)> edit) {
  return hears([=](Bytes& frame, const P2pBlock& block) {
    if (frame.size() > pdu_at) edit(frame, block);
  });
}

/// A word that was asked for stands in the answer, with whatever is wrong around it.
void one_word(Bytes& frame, const P2pBlock& block) {
  constexpr std::size_t count_of_bytes_at = pdu_at + 1, whole = pdu_at + 4;
  if (block.type != 'W' || block.continuous || frame[pdu_at] != 3) return;
  frame.resize(whole);
  frame[count_of_bytes_at] = 2;
  set_number(frame, length_at, whole - mbap_prefix);
}

/// A number of a transaction is made that of the request where `passes` says so.
Behaviour transaction_taken(std::function<bool(unsigned came, unsigned sent)> passes) {
  const auto sent = std::make_shared<unsigned>(0);
  return {.asks =
              [=](P2pDriver& good, const P2pBlock& block, const PlcMemory& memory) {
                Result<Bytes> frame = good.request(block, memory);
                if (frame) *sent = number_at(*frame, 0);
                return frame;
              },
          .takes =
              [=](const P2pDriver& good, const P2pBlock& block, Bytes frame, PlcMemory& memory) {
                if (frame.size() > pdu_at)
                  set_number(frame, 0, passes(number_at(frame, 0), *sent) ? *sent : *sent + 1);
                return good.take(block, frame, memory);
              }};
}

/// The good driver's judgement `from` is taken for `to`.
MakeBehaviour judges(std::uint16_t from, std::uint16_t to) {
  return takes([=](const P2pDriver& good, const P2pBlock& block, const Bytes& frame,
                   PlcMemory& memory) -> std::optional<std::uint16_t> {
    const auto error = good.take(block, frame, memory);
    return error == from ? to : error;
  });
}

/// An exception of this code is a normal end.
MakeBehaviour unknown_exception(Byte code) {
  return takes([=](const P2pDriver& good, const P2pBlock& block, const Bytes& frame,
                   PlcMemory& memory) -> std::optional<std::uint16_t> {
    const auto error = good.take(block, frame, memory);
    const bool refused = error == p2p::p2p_error::nak && frame.back() == code;
    return refused ? p2p::p2p_error::none : error;
  });
}

MakeBehaviour links(std::function<bool(Burst& burst)> hears_link) {
  return [=] { return Behaviour{.hears_link = hears_link}; };
}

/// Behind the first frame of a segment nothing is looked at.
bool first_frame_alone(Burst& burst) {
  if (burst.event != LinkEvent::data || burst.bytes.size() < mbap_prefix) return true;
  const std::size_t size = mbap_prefix + number_at(burst.bytes, length_at);
  if (burst.bytes.size() > size) burst.bytes.resize(size);
  return true;
}

/// A segment that does not hold a whole answer is none.
bool whole_frames_alone(Burst& burst) {
  if (burst.event != LinkEvent::data) return true;
  return burst.bytes.size() > mbap_prefix &&
         burst.bytes.size() >= mbap_prefix + number_at(burst.bytes, length_at);
}

/// What comes in a segment is a frame, whatever its length says.
bool length_not_looked_at(Burst& burst) {
  if (burst.event == LinkEvent::data && burst.bytes.size() > pdu_at)
    set_number(burst.bytes, length_at, static_cast<unsigned>(burst.bytes.size() - mbap_prefix));
  return true;
}

MakeBehaviour deaf_to_links(LinkEvent deaf) {
  return links([=](Burst& burst) { return burst.event != deaf; });
}

/// Where it asks there is nobody: the bench listens at 502.
Behaviour asks_at_port_of_xgt() {
  return {.partner = [](p2p::NetworkPartner& partner) { partner.port = 2004; },
          .does = [](std::vector<Burst>& doings) { doings.clear(); }};
}

}  // namespace

std::vector<Fault> modbus_tcp_request_faults() {
  return {
      {"tcp_port_of_xgt", "the partner is asked at port 2004", asks_at_port_of_xgt,
       "modbus_tcp/client/tcp/header", "no request within"},
      {"tcp_protocol_not_0", "requests have protocol 1",
       header_word(protocol_at, [](unsigned) { return 1u; }), "modbus_tcp/client/tcp/header",
       "protocol"},
      {"tcp_length_without_unit", "the length does not count the unit",
       header_word(length_at, [](unsigned right) { return right - 1; }),
       "modbus_tcp/client/tcp/header", "length"},
      {"tcp_length_of_frame", "the length counts the whole frame",
       header_word(length_at, [](unsigned right) { return right + 6; }),
       "modbus_tcp/client/tcp/header", "length"},
      {"tcp_unit_0", "the unit is 0 whatever the station of the block is",
       spoils([](Bytes& frame) { frame.at(unit_at) = 0; }), "modbus_tcp/client/tcp/unit/s2",
       "unit"},
      {"tcp_unit_ff", "the unit is 255 whatever the station of the block is",
       spoils([](Bytes& frame) { frame.at(unit_at) = 0xFF; }), "modbus_tcp/client/tcp/unit/s2",
       "unit"},
      {"tcp_coils_by_02", "bits of 0XXXX are read by function 02", function_by(1, 2),
       "modbus_tcp/client/tcp/read_bit/f01_on", "function code: expected"},
      {"tcp_inputs_by_01", "bits of 1XXXX are read by function 01", function_by(2, 1),
       "modbus_tcp/client/tcp/read_bit/f02_on", "function code: expected"},
      {"tcp_holding_registers_by_04", "words of 4XXXX are read by function 04", function_by(3, 4),
       "modbus_tcp/client/tcp/read_single/f03", "function code: expected"},
      {"tcp_input_registers_by_03", "words of 3XXXX are read by function 03", function_by(4, 3),
       "modbus_tcp/client/tcp/read_single/f04", "function code: expected"},
      {"tcp_coil_by_0f", "a single bit is written by function 0F",
       asks_for([](P2pBlock& block) { block.continuous = block.continuous || block.type == 'X'; }),
       "modbus_tcp/client/tcp/write_single/f05_on", "function code"},
      {"tcp_word_by_10", "a single word is written by function 10",
       asks_for([](P2pBlock& block) { block.continuous = block.continuous || block.type == 'W'; }),
       "modbus_tcp/client/tcp/write_single/f06", "function code"},
      {"tcp_run_of_bits_by_05", "a run of bits is written by function 05",
       function_by(bits_by_0f, bit_by_05), "modbus_tcp/client/tcp/write_continuous/f0f",
       "function code: expected"},
      {"tcp_run_of_words_by_06", "a run of words is written by function 06",
       function_by(words_by_10, word_by_06), "modbus_tcp/client/tcp/write_continuous/f10",
       "function code: expected"},
      {"tcp_address_minus_one", "addresses are taken as one-based: one too low goes out",
       sends_pdu([](Bytes& pdu) { set_number(pdu, 1, number_at(pdu, 1) - 1); }),
       "modbus_tcp/client/tcp/read_single/f03", "address: expected"},
      {"tcp_address_low_byte_first", "the address stands low byte first",
       sends_pdu([](Bytes& pdu) { std::swap(pdu.at(1), pdu.at(2)); }),
       "modbus_tcp/client/tcp/read_single/f03", "address: expected"},
      {"tcp_count_plus_one", "the count of a run is one too high", sends_pdu([](Bytes& pdu) {
         if (pdu[0] != bit_by_05 && pdu[0] != word_by_06 && number_at(pdu, 3) > 1)
           set_number(pdu, 3, number_at(pdu, 3) + 1);
       }),
       "modbus_tcp/client/tcp/read_continuous/f03", "count: expected"},
      {"tcp_byte_count_of_words", "the byte count is the count of words", sends_pdu([](Bytes& pdu) {
         if (pdu[0] == words_by_10) pdu.at(5) = pdu.at(4);
       }),
       "modbus_tcp/client/tcp/write_continuous/f10", "byte count: expected"},
      {"tcp_coil_on_is_0001", "a bit that is on goes out as 0001", sends_pdu([](Bytes& pdu) {
         if (pdu[0] == bit_by_05 && pdu.at(3) == 0xFF) set_number(pdu, 3, 1);
       }),
       "modbus_tcp/client/tcp/write_single/f05_on", "value: expected"},
      {"tcp_words_low_byte_first", "words that are written go out low byte first",
       sends_pdu([](Bytes& pdu) {
         if (pdu[0] == word_by_06) std::swap(pdu.at(3), pdu.at(4));
         for (std::size_t i = 6; pdu[0] == words_by_10 && i + 1 < pdu.size(); i += 2)
           std::swap(pdu[i], pdu[i + 1]);
       }),
       "modbus_tcp/client/tcp/write_single/f06", "value: expected"},
  };
}

std::vector<Fault> modbus_tcp_answer_faults() {
  return {
      {"tcp_any_transaction", "an answer of another transaction is taken",
       [] { return transaction_taken([](unsigned, unsigned) { return true; }); },
       "modbus_tcp/client/tcp/wrong_transaction", "%MW119 holds 13576BCD9BDF86427531FDB9"},
      {"tcp_transaction_low_byte_first", "the transaction of an answer is read low byte first",
       [] {
         return transaction_taken([](unsigned came, unsigned sent) {
           return came == ((sent << 8 | sent >> 8) & 0xFFFF);
         });
       },
       "modbus_tcp/client/tcp/read_single/f03", "%MW119 holds 135724689BDF86427531FDB9"},
      {"tcp_any_protocol", "an answer of another protocol is taken",
       answer([](Bytes& frame, const P2pBlock&) { set_number(frame, protocol_at, 0); }),
       "modbus_tcp/client/tcp/wrong_protocol", "%MW119 holds 13576BCD9BDF86427531FDB9"},
      {"tcp_any_unit", "an answer of another unit is taken",
       answer([](Bytes& frame, const P2pBlock& block) {
         frame[unit_at] = static_cast<Byte>(block.station);
       }),
       "modbus_tcp/client/tcp/wrong_unit", "%MW119 holds 13576BCD9BDF86427531FDB9"},
      {"tcp_any_function", "an answer to another function is taken",
       answer([](Bytes& frame, const P2pBlock&) {
         if (frame[pdu_at] == 4 && frame.size() == pdu_at + 4) frame[pdu_at] = 3;
       }),
       "modbus_tcp/client/tcp/wrong_function", "%MW119 holds 13576BCD9BDF86427531FDB9"},
      {"tcp_surplus_ignored", "of an answer that is too long the first word is saved",
       answer([](Bytes& frame, const P2pBlock& block) {
         if (frame.size() > pdu_at + 4) one_word(frame, block);
       }),
       "modbus_tcp/client/tcp/too_long", "%MW119 holds 13576BCD9BDF86427531FDB9"},
      {"tcp_short_answer_padded", "what is missing of an answer is taken as 00",
       answer([](Bytes& frame, const P2pBlock& block) {
         if (frame.size() == pdu_at + 3) one_word(frame, block);
       }),
       "modbus_tcp/client/tcp/too_short", "%MW119 holds 13576B009BDF86427531FDB9"},
      {"tcp_byte_count_not_compared", "the byte count of an answer is not looked at",
       answer([](Bytes& frame, const P2pBlock& block) {
         if (frame.size() == pdu_at + 4) one_word(frame, block);
       }),
       "modbus_tcp/client/tcp/count_lies", "%MW119 holds 13576BCD9BDF86427531FDB9"},
      {"tcp_echo_is_normal", "the request itself is taken for a normal end",
       takes([](const P2pDriver& good, const P2pBlock& block, const Bytes& frame,
                PlcMemory& memory) -> std::optional<std::uint16_t> {
         if (frame.size() == pdu_at + 5) return p2p::p2p_error::none;
         return good.take(block, frame, memory);
       }),
       "modbus_tcp/client/tcp/echo", "%LW512 holds 0001"},
      {"tcp_exception_is_normal", "an exception is a normal end",
       judges(p2p::p2p_error::nak, p2p::p2p_error::none), "modbus_tcp/client/tcp/exception/e02",
       "%LW512 holds 0001"},
      {"tcp_exception_04_is_normal", "exception 04 is a normal end", unknown_exception(4),
       "modbus_tcp/client/tcp/exception/e04", "%LW512 holds 0001"},
      {"tcp_length_not_looked_at", "a segment is a frame, whatever its length says",
       links(length_not_looked_at), "modbus_tcp/client/tcp/wrong_length/n261",
       "%MW119 holds 13576BCD9BDF86427531FDB9"},
      {"tcp_segment_is_frame", "an answer in several segments is none", links(whole_frames_alone),
       "modbus_tcp/client/tcp/answer_in_pieces/two", "%MW119 holds 135724689BDF86427531FDB9"},
      {"tcp_second_frame_lost", "of two answers in a segment the second is lost",
       links(first_frame_alone), "modbus_tcp/client/tcp/answers_in_one_segment",
       "%MW119 holds 135724689BDF86427531FDB9"},
      {"tcp_read_low_byte_first", "words that are read are saved low byte first",
       answer([](Bytes& frame, const P2pBlock& block) {
         for (std::size_t i = pdu_at + 2; block.type == 'W' && i + 1 < frame.size(); i += 2)
           if (frame[pdu_at] <= 4) std::swap(frame[i], frame[i + 1]);
       }),
       "modbus_tcp/client/tcp/read_single/f03", "%MW119 holds 1357BC5A9BDF86427531FDB9"},
      {"tcp_padding_saved", "the padding of the last byte of bits is saved, too",
       after_saving([](const P2pBlock& block, PlcMemory& memory) {
         for (unsigned i = block.elements(); block.type == 'X' && i % 8 != 0; ++i)
           memory.write(block.variables[0].own + i, 0);
       }),
       "modbus_tcp/client/tcp/read_continuous/f01", "%MW119 holds"},
      {"tcp_saves_nothing", "a read ends, and saves nothing",
       takes(
           [](const P2pDriver& good, const P2pBlock& block, const Bytes& frame, PlcMemory& memory) {
             PlcMemory elsewhere(memory.model());
             return good.take(block, frame, elsewhere);
           }),
       "modbus_tcp/client/tcp/read_single/f03", "%MW119 holds 135724689BDF86427531FDB9"},
  };
}

std::vector<Fault> modbus_tcp_link_faults() {
  return {
      {"tcp_hangs_up", "the connection is closed after each answer",
       [] { return Behaviour{.hangs_up = true}; }, "modbus_tcp/client/tcp/kept", ""},
      {"tcp_does_not_reconnect", "a connection that was lost is not opened again",
       does_not_reconnect, "modbus_tcp/client/tcp/again_after_fin", ""},
      {"tcp_deaf_to_reset", "a connection that was reset is used on",
       deaf_to_links(LinkEvent::reset), "modbus_tcp/client/tcp/again_after_rst", ""},
      {"tcp_half_closed_stays", "a FIN of the partner is not answered",
       deaf_to_links(LinkEvent::closed), "modbus_tcp/client/tcp/fin_ends", ""},
      {"tcp_keeps_rests", "half an answer of a lost connection stands before the next one",
       [] { return Behaviour{.keeps_rests = true}; }, "modbus_tcp/client/tcp/rst_in_mid_answer",
       ""},
      {"tcp_lost_is_no_error", "a request whose connection is lost leaves no trace",
       hides(p2p::p2p_error::send), "modbus_tcp/client/tcp/rst_before_answer", "%LW512 holds 0000"},
      {"tcp_time_out_long", "10 s instead of 5 s",
       timing([](p2p::P2pClient::Timing& timing) { timing.time_out = 10s; }),
       "modbus_tcp/client/tcp/none", "%LW512 holds 0000"},
      {"tcp_time_out_is_normal", "a request without an answer ends normally",
       ends([](const Outcome& before, Outcome& now) {
         if (now.status == p2p::p2p_error::time_out)
           now = {.ndr = true, .services = before.services + 1, .errors = before.errors};
       }),
       "modbus_tcp/client/tcp/none", "%LW512 holds 0001"},
      {"tcp_late_saved", "an answer that comes after the time-out is saved",
       [] { return Behaviour{.saves_late = true}; }, "modbus_tcp/client/tcp/late",
       "%MW119 holds 13576BCD9BDF86427531FDB9"},
      {"tcp_two_at_once", "a block does not wait for the answer to another",
       [] { return Behaviour{.all_at_once = true}; }, "modbus_tcp/client/tcp/one_at_a_time", ""},
      {"tcp_one_connection", "all channels share a connection",
       each_block([](P2pBlock& block) { block.channel = 1; }), "modbus_tcp/client/tcp/two_channels",
       ""},
      {"tcp_power_cycle_keeps", "a connection is used on when the power was gone",
       deaf_to("power_cycle"), "modbus_tcp/client/tcp/power_cycle_while_busy", ""},
      {"tcp_both_edges", "the block fires when its flag falls, too", trigger(Trigger::both_edges),
       "modbus_tcp/client/tcp/edge", "where silence is due"},
      {"tcp_edge_missed", "every second rising edge is not seen",
       trigger(Trigger::every_second_edge), "modbus_tcp/client/tcp/edge", "no request within"},
  };
}

}  // namespace fieldproof::p2p_broken
