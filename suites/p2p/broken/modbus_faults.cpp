// Modbus clients, RTU and ASCII (Cnet EN 10.3, Cnet KO 6.4, 11.3).
#include "suites/p2p/broken/faults.hpp"

namespace fieldproof::p2p_broken {

using modbus::ModbusFrame;
using modbus::ModbusMode;
using p2p::P2pBlock;

namespace {

enum : Byte {
  read_coils = 1,
  read_inputs,
  read_holding,
  read_input_words,
  write_coil,
  write_word,
  write_coils = 0x0F,
  write_words
};

ModbusMode mode_of(ByteView frame) {
  return !frame.empty() && frame[0] == ':' ? ModbusMode::ascii : ModbusMode::rtu;
}

bool reads_bits(const P2pBlock& block) {
  return block.function == P2pBlock::Function::read && block.type == 'X';
}

/// Sends another PDU than the good one.
MakeBehaviour sends(std::function<void(Bytes& pdu)> edit) {
  return spoils([=](Bytes& frame) {
    ModbusFrame right = modbus::decode_modbus_frame(mode_of(frame), frame);
    edit(right.pdu);
    frame = modbus::encode_modbus_frame(mode_of(frame), right.station, right.pdu);
  });
}

MakeBehaviour function_code(Byte right, Byte wrong) {
  return sends([=](Bytes& pdu) {
    if (pdu[0] == right) pdu[0] = wrong;
  });
}

unsigned word(const Bytes& pdu, std::size_t at) {
  return static_cast<unsigned>(pdu.at(at) << 8 | pdu.at(at + 1));
}

void set_word(Bytes& pdu, std::size_t at, unsigned value) {
  pdu.at(at) = static_cast<Byte>(value >> 8);
  pdu.at(at + 1) = static_cast<Byte>(value);
}

MakeBehaviour address(int offset) {
  return sends([=](Bytes& pdu) { set_word(pdu, 1, word(pdu, 1) + static_cast<unsigned>(offset)); });
}

MakeBehaviour table(char right, char wrong) {
  return asks_for([=](P2pBlock& block) {
    char& digit = block.variables[0].partner.at(2);
    if (digit == right)
      digit = wrong;
    else if (digit == wrong)
      digit = right;
  });
}

void hex_as_decimal(Bytes& pdu) {
  char digits[5];
  std::snprintf(digits, sizeof digits, "%04X", word(pdu, 1));
  set_word(pdu, 1, static_cast<unsigned>(std::atoi(digits)));
}

void swap_words(Bytes& pdu) {
  if (pdu[0] == write_word) std::swap(pdu.at(3), pdu.at(4));
  for (std::size_t i = 6; pdu[0] == write_words && i + 1 < pdu.size(); i += 2)
    std::swap(pdu[i], pdu[i + 1]);
}

Byte bits_reversed(Byte byte) {
  Byte wrong = 0;
  for (int i = 0; i < 8; ++i) wrong = static_cast<Byte>(wrong << 1 | (byte >> i & 1));
  return wrong;
}

/// Takes another reply for that which came.
MakeBehaviour understands_modbus(
    std::function<void(ModbusFrame& reply, const P2pBlock& block)> edit) {
  return hears([=](Bytes& frame, const P2pBlock& block) {
    const ModbusMode mode = mode_of(frame);
    ModbusFrame reply = modbus::decode_modbus_frame(mode, frame);
    if (reply.fault != 0 || reply.pdu.size() < 2) return;
    edit(reply, block);
    frame = modbus::encode_modbus_frame(mode, reply.station, reply.pdu);
  });
}

/// A block that ends with one STATUS shows another.
MakeBehaviour status_told(std::uint16_t right, std::uint16_t wrong) {
  return ends([=](const Outcome&, Outcome& now) {
    if (now.status == right) now.status = wrong;
  });
}

void accept_any_crc(Bytes& frame, const P2pBlock&) {
  if (mode_of(frame) == ModbusMode::ascii || frame.size() < 4) return;
  frame = modbus::encode_modbus_frame(ModbusMode::rtu, frame[0],
                                      ByteView(frame).subspan(1, frame.size() - 3));
}

void accept_any_lrc(Bytes& frame, const P2pBlock&) {
  const auto bytes = frame.size() < 9
                         ? std::nullopt
                         : from_hex(to_text(ByteView(frame).subspan(1, frame.size() - 5)));
  if (bytes)
    frame =
        modbus::encode_modbus_frame(ModbusMode::ascii, bytes->at(0), ByteView(*bytes).subspan(1));
}

/// A check that is right in one of its two bytes or digits is taken: `from_end` is where it stands.
auto accept_one(void (*accept_any)(Bytes&, const P2pBlock&), std::size_t from_end) {
  return [=](Bytes& frame, const P2pBlock& block) {
    Bytes right = frame;
    accept_any(right, block);
    if (right.size() == frame.size() && frame.size() > from_end &&
        frame[frame.size() - from_end] == right[frame.size() - from_end])
      frame = right;
  };
}

std::optional<std::uint16_t> exception_is_normal(const p2p::P2pDriver& good, const P2pBlock& block,
                                                 const Bytes& frame, plc::PlcMemory& memory) {
  const auto error = good.take(block, frame, memory);
  return error == p2p::p2p_error::nak ? p2p::p2p_error::none : error;
}

/// Of the codes that the manual prints with its examples.
std::optional<std::uint16_t> knows_no_server_error(const p2p::P2pDriver& good,
                                                   const P2pBlock& block, const Bytes& frame,
                                                   plc::PlcMemory& memory) {
  const bool server_error = frame.size() > 2 && frame[2] == 0x04;
  const auto error = good.take(block, frame, memory);
  return server_error && error == p2p::p2p_error::nak ? p2p::p2p_error::none : error;
}

std::optional<std::uint16_t> echo_not_compared(const p2p::P2pDriver& good, const P2pBlock& block,
                                               const Bytes& frame, plc::PlcMemory& memory) {
  const auto error = good.take(block, frame, memory);
  return block.function == P2pBlock::Function::write && error == p2p::p2p_error::driver
             ? p2p::p2p_error::none
             : error;
}

std::optional<std::uint16_t> ended_by_own_request(const p2p::P2pDriver& good, const P2pBlock& block,
                                                  const Bytes& frame, plc::PlcMemory& memory) {
  return good.take(block, frame, memory).value_or(p2p::p2p_error::length);
}

/// Whole bytes of bits are saved, padding and all.
void save_padding(const P2pBlock& block, plc::PlcMemory& memory) {
  if (block.type != 'X') return;
  for (unsigned i = block.elements(); i % 8 != 0; ++i) memory.write(block.variables[0].own + i, 0);
}

}  // namespace

std::vector<Fault> modbus_faults() {
  return {
      {"coil_by_0f", "a single bit is written by function 0F",
       asks_for([](P2pBlock& block) { block.continuous = block.continuous || block.type == 'X'; }),
       "modbus_rtu/client/functions/write_bit/a0142_off", "function code: expected"},
      {"word_by_10", "a single word is written by function 10",
       asks_for([](P2pBlock& block) { block.continuous = block.continuous || block.type == 'W'; }),
       "modbus_rtu/client/functions/write_word/a0001", "function code: expected"},
      {"run_by_single", "a run is written by function 05 or 06", asks_for([](P2pBlock& block) {
         block.continuous = block.continuous && block.function == P2pBlock::Function::read;
       }),
       "modbus_rtu/client/example/write_m2_bits", "function code: expected"},
      {"input_bits_by_01", "input bits are read by function 01",
       function_code(read_inputs, read_coils), "modbus_rtu/client/functions/read_bit/a10001_on",
       "function code: expected"},
      {"input_words_by_03", "input registers are read by function 03",
       function_code(read_input_words, read_holding),
       "modbus_rtu/client/functions/read_word/a30000", "function code: expected"},
      {"tables_3_and_4_swapped", "0x3 is taken for 0x4, and 0x4 for 0x3", table('3', '4'),
       "modbus_rtu/client/example/read_p0", "function code: expected"},
      {"tables_0_and_1_swapped", "0x0 is taken for 0x1, and 0x1 for 0x0", table('0', '1'),
       "modbus_rtu/client/example/read_p2_bit_1/en", "function code: expected"},
      {"address_minus_one",
       "the address of the partner is taken as one-based: one too low goes out", address(-1),
       "modbus_rtu/client/example/write_m100", "address: expected 0001, got 0000"},
      {"address_plus_one", "the address that goes out is one-based", address(1),
       "modbus_rtu/client/example/write_m100", "address: expected 0001, got 0002"},
      {"address_decimal", "the digits of the address are taken as decimal", sends(hex_as_decimal),
       "modbus_rtu/client/functions/write_word/a0010", "address: expected 0010, got 000A"},
      {"count_plus_one", "the count is one too high", sends([](Bytes& pdu) {
         if (pdu[0] != write_coil && pdu[0] != write_word) set_word(pdu, 3, word(pdu, 3) + 1);
       }),
       "modbus_rtu/client/functions/read_word/a4000a", "count: expected 0001, got 0002"},
      {"byte_count_missing", "0F and 10 have no byte count", sends([](Bytes& pdu) {
         if (pdu[0] >= write_coils) pdu.erase(pdu.begin() + 5);
       }),
       "modbus_rtu/client/example/write_d0", "byte count: expected 08"},
      {"byte_count_of_words", "the byte count is the count of words", sends([](Bytes& pdu) {
         if (pdu[0] == write_words) pdu.at(5) = pdu.at(4);
       }),
       "modbus_rtu/client/example/write_d0", "byte count: expected 08"},
      {"coil_on_is_0001", "a bit that is on goes out as 0001", sends([](Bytes& pdu) {
         if (pdu[0] == write_coil && pdu.at(3) == 0xFF) set_word(pdu, 3, 1);
       }),
       "modbus_rtu/client/functions/write_bit/a0001_on", "value: expected FF00, got 0001"},
      {"words_low_byte_first", "words that are written go out low byte first", sends(swap_words),
       "modbus_rtu/client/example/write_d0",
       "data: expected 1122334455667788, got 2211443366558877"},
      {"bits_from_the_top", "bits that are written begin at bit 7 of each byte",
       sends([](Bytes& pdu) {
         for (std::size_t i = 6; pdu[0] == write_coils && i < pdu.size(); ++i)
           pdu[i] = bits_reversed(pdu[i]);
       }),
       "modbus_rtu/client/functions/example_9_4_7", "data: expected CD01, got B380"},
      {"crc_high_byte_first", "the CRC goes out high byte first",
       spoils([](Bytes& frame) { std::swap(frame.at(frame.size() - 2), frame.back()); }),
       "modbus_rtu/client/example/write_m100", "CRC: expected E31B, got 1BE3"},
      {"crc_missing", "the request has no CRC",
       spoils([](Bytes& frame) { frame.resize(frame.size() - 2); }),
       "modbus_rtu/client/example/write_m100", "CRC: expected E31B, got 0106"},
      {"ended_by_own_request", "its own request that comes back ends a request, as a wrong length",
       takes(ended_by_own_request), "modbus_rtu/client/error/echo", "%MW120 holds 2468"},
      {"lrc_missing", "the request has no LRC",
       spoils([](Bytes& frame) { frame.erase(frame.end() - 4, frame.end() - 2); }),
       "modbus_ascii/client/example/write_m100", "value: expected 5ABC, got 5A"},
      {"lrc_without_complement", "the LRC is the sum, not its two's complement",
       spoils([](Bytes& frame) {
         const Byte lrc = from_hex(to_text(ByteView(frame).subspan(frame.size() - 4, 2)))->at(0);
         std::ranges::copy(hex_number(static_cast<Byte>(-lrc), 2), frame.end() - 4);
       }),
       "modbus_ascii/client/example/write_m100", "LRC: expected E2, got 1E"},
      {"lf_missing", "an ASCII request ends with CR alone",
       spoils([](Bytes& frame) { frame.pop_back(); }), "modbus_ascii/client/example/write_m100",
       "tail: expected"},
      {"read_words_swapped", "words that are read are saved low byte first",
       understands_modbus([](ModbusFrame& reply, const P2pBlock&) {
         if (reply.pdu[0] != read_holding && reply.pdu[0] != read_input_words) return;
         for (std::size_t i = 2; i + 1 < reply.pdu.size(); i += 2)
           std::swap(reply.pdu[i], reply.pdu[i + 1]);
       }),
       "modbus_rtu/client/example/read_p0", "%MW149 holds 2468A5C36F5E120E379B1357"},
      {"read_bits_from_the_top", "bits that are read begin at bit 7 of each byte",
       understands_modbus([](ModbusFrame& reply, const P2pBlock& block) {
         for (std::size_t i = 2; reads_bits(block) && i < reply.pdu.size(); ++i)
           reply.pdu[i] = bits_reversed(reply.pdu[i]);
       }),
       "modbus_rtu/client/example/read_m10_bits/printed", "%MW179 holds 2468B2891357"},
      {"padding_saved", "the padding of the last byte of bits is saved, too",
       after_saving(save_padding), "modbus_rtu/client/data/read_bits/b9_at_7",
       "%MW119 holds 1357DBE89B8086427531FDB9"},
      {"modbus_foreign_station", "the reply of another station is accepted",
       understands_modbus([](ModbusFrame& reply, const P2pBlock& block) {
         reply.station = static_cast<Byte>(block.station);
       }),
       "modbus_rtu/client/error/wrong_station/s3", "%MW119 holds 13575ABC9BDF86427531FDB9"},
      {"ascii_foreign_station", "the reply of another station is accepted",
       understands_modbus([](ModbusFrame& reply, const P2pBlock& block) {
         reply.station = static_cast<Byte>(block.station);
       }),
       "modbus_ascii/client/error/partner/wrong_station", "%MW119 holds"},
      {"ascii_station_not_told", "the STATUS of another station is that of another function",
       status_told(p2p::p2p_error::station, p2p::p2p_error::driver),
       "modbus_ascii/client/error/partner/wrong_station", "%LW513 holds 0005"},
      {"ascii_length_as_check", "the STATUS of a wrong length is that of a wrong check",
       status_told(p2p::p2p_error::length, p2p::p2p_error::bcc),
       "modbus_ascii/client/error/partner/short", "%LW513 holds 0003"},
      {"ascii_not_hex_as_check", "the STATUS of what is no hex is that of a wrong check",
       status_told(p2p::p2p_error::not_hex, p2p::p2p_error::bcc),
       "modbus_ascii/client/error/partner/not_hex", "%LW513 holds 0003"},
      {"ascii_head_as_time_out", "the STATUS of a wrong head is that of a time-out",
       status_told(p2p::p2p_error::head, p2p::p2p_error::time_out),
       "modbus_ascii/client/error/partner_without_frame/wrong_head", "%LW513 holds 000A"},
      {"exception_is_normal", "an exception is a normal end", takes(exception_is_normal),
       "modbus_rtu/client/error/exception/e02", "%LW512 holds 0001"},
      {"server_error_is_normal", "exception 04 is a normal end", takes(knows_no_server_error),
       "modbus_rtu/client/error/printed_refusal/f03", "%LW512 holds 0001"},
      {"server_error_of_a_write_is_normal", "exception 04 to a write is a normal end",
       takes(knows_no_server_error), "modbus_rtu/client/error/printed_refusal_of_single/f05",
       "%LW512 holds 0001"},
      {"echo_not_compared", "a write whose echo has another address or value ends normally",
       takes(echo_not_compared), "modbus_rtu/client/error/other_echo_06/other_value",
       "%LW512 holds 0001"},
      {"crc_ignored", "a wrong CRC is accepted", hears(accept_any_crc),
       "modbus_rtu/client/error/wrong_check/wrong", "%MW119 holds 13575ABC9BDF86427531FDB9"},
      {"crc_first_byte_alone", "of the CRC the first byte alone is compared",
       hears(accept_one(accept_any_crc, 2)), "modbus_rtu/client/error/wrong_check/second_byte",
       "%MW119 holds 13575ABC9BDF86427531FDB9"},
      {"crc_second_byte_alone", "of the CRC the second byte alone is compared",
       hears(accept_one(accept_any_crc, 1)), "modbus_rtu/client/error/wrong_check/wrong",
       "%MW119 holds 13575ABC9BDF86427531FDB9"},
      {"lrc_first_digit_alone", "of the LRC the first digit alone is compared",
       hears(accept_one(accept_any_lrc, 4)), "modbus_ascii/client/error/wrong_check/wrong",
       "%MW119 holds 13575ABC9BDF86427531FDB9"},
      {"lrc_second_digit_alone", "of the LRC the second digit alone is compared",
       hears(accept_one(accept_any_lrc, 3)), "modbus_ascii/client/error/wrong_check/first_digit",
       "%MW119 holds 13575ABC9BDF86427531FDB9"},
      {"lrc_ignored", "a wrong LRC is accepted", hears(accept_any_lrc),
       "modbus_ascii/client/error/wrong_check/wrong", "%MW119 holds 13575ABC9BDF86427531FDB9"},
  };
}

}  // namespace fieldproof::p2p_broken
