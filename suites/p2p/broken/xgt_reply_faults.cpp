// What the XGT client makes of a reply (Cnet EN and KO 6.3, 7.1, Appendix 3.3).
#include "suites/p2p/broken/faults.hpp"

namespace fieldproof::p2p_broken {

using p2p::P2pBlock;
using p2p::P2pDriver;
using plc::PlcMemory;
using xgt_cnet::XgtReply;

namespace {

bool reads(const P2pBlock& block) { return block.function == P2pBlock::Function::read; }

/// Takes another reply for that which came.
MakeBehaviour understands_xgt(std::function<void(XgtReply& reply, const P2pBlock& block)> edit) {
  return hears([=](Bytes& bytes, const P2pBlock& block) {
    const Bytes right = bytes;
    XgtReply reply = xgt_cnet::parse_reply(right);
    if (reply.fault.check < xgt_cnet::XgtCheck::station) return;
    edit(reply, block);
    bytes.clear();
    xgt_cnet::encode_reply(reply, bytes);
  });
}

void accept_any_check(Bytes& frame, const P2pBlock&) {
  if (frame.size() < 4) return;
  const std::string right =
      hex_number(xgt_cnet::xgt_bcc(ByteView(frame).first(frame.size() - 2)), 2);
  std::ranges::copy(right, frame.end() - 2);
}

/// A BCC that is right in its first digit is taken.
void accept_first_digit(Bytes& frame, const P2pBlock& block) {
  Bytes right = frame;
  accept_any_check(right, block);
  if (frame.size() > 4 && frame[frame.size() - 2] == right[frame.size() - 2]) frame = right;
}
void accept_second_digit(Bytes& frame, const P2pBlock& block) {
  Bytes right = frame;
  accept_any_check(right, block);
  if (frame.size() > 4 && frame.back() == right.back()) frame = right;
}

using Value = std::uint64_t;

/// Saves another value of each element.
MakeBehaviour saves(std::function<Value(Value right, char type)> wrong) {
  return after_saving([=](const P2pBlock& block, PlcMemory& memory) {
    for (const p2p::P2pVariable& variable : block.variables)
      for (unsigned i = 0; i < block.elements(); ++i)
        memory.write(variable.own + i, wrong(memory.read(variable.own + i), variable.own.type));
  });
}

Value bytes_swapped(Value right, char type) {
  Value wrong = 0;
  for (unsigned i = 0; i < plc::type_bytes(type); ++i) wrong = wrong << 8 | (right >> 8 * i & 0xFF);
  return wrong;
}

Value halves_swapped(Value right, char type) {
  if (plc::type_bytes(type) < 4) return right;
  const unsigned half = 4 * plc::type_bytes(type);
  const Value low = (Value{1} << half) - 1;
  return right << half | (right >> half & low);
}

/// What a reply holds is saved whatever it is, before it is judged.
std::optional<std::uint16_t> save_first(const P2pDriver& good, const P2pBlock& block,
                                        const Bytes& frame, PlcMemory& memory) {
  const XgtReply reply = xgt_cnet::parse_reply(frame);
  for (std::size_t i = 0; reads(block) && i < block.variables.size(); ++i) {
    const std::int64_t value = xgt_cnet::hex_value(reply.data.at(i).substr(0, 4));
    if (value >= 0) memory.write(block.variables[i].own, static_cast<Value>(value));
  }
  return good.take(block, frame, memory);
}

/// The code of a NAK lands where the data belong.
std::optional<std::uint16_t> save_nak(const P2pDriver& good, const P2pBlock& block,
                                      const Bytes& frame, PlcMemory& memory) {
  const auto error = good.take(block, frame, memory);
  if (error == p2p::p2p_error::nak && reads(block))
    memory.write(block.variables[0].own, xgt_cnet::parse_reply(frame).error);
  return error;
}

MakeBehaviour instead_of(std::uint16_t right, std::uint16_t wrong) {
  return takes(
      [=](const P2pDriver& good, const P2pBlock& block, const Bytes& frame, PlcMemory& memory) {
        const auto error = good.take(block, frame, memory);
        return error == right ? wrong : error;
      });
}

std::optional<std::uint16_t> ignore_wrong(const P2pDriver& good, const P2pBlock& block,
                                          const Bytes& frame, PlcMemory& memory) {
  const auto error = good.take(block, frame, memory);
  return error == p2p::p2p_error::station ? std::nullopt : error;
}

void save_whole_word(const P2pBlock& block, PlcMemory& memory) {
  for (const p2p::P2pVariable& variable : block.variables) {
    if (variable.own.type != 'X' && variable.own.type != 'B') continue;
    const unsigned in_a_word = variable.own.type == 'X' ? 16 : 2;
    const Value value = memory.read(variable.own);
    plc::DeviceAddress one = variable.own;
    for (one.index -= one.index % in_a_word;
         one.index / in_a_word == variable.own.index / in_a_word; ++one.index)
      memory.write(one, 0);
    memory.write(variable.own, value);
  }
}

void move_up(P2pBlock& block) {
  for (p2p::P2pVariable& variable : block.variables)
    if (reads(block)) variable.own = variable.own + 1;
}

}  // namespace

std::vector<Fault> xgt_reply_faults() {
  return {
      {"save_area_off_by_one", "what is read is saved one element too high", each_block(move_up),
       "xgt_cnet/client/read/single/word", "%MW119 holds 135724685ABC86427531FDB9"},
      {"bytes_swapped", "what is read is saved low byte first", saves(bytes_swapped),
       "xgt_cnet/client/read/single/word", "%MW119 holds 1357BC5A9BDF86427531FDB9"},
      {"halves_swapped", "dwords and lwords are saved low half first", saves(halves_swapped),
       "xgt_cnet/client/read/single_types/dword", "%MW119 holds 13571234ABCD86427531FDB9"},
      {"bit_saves_its_word", "a bit or byte clears the rest of its word",
       after_saving(save_whole_word), "xgt_cnet/client/read/single_bit/bit_on",
       "%MW119 holds 135700109BDF86427531FDB9"},
      {"saves_first_variable_only", "of several variables only the first is saved",
       takes(
           [](const P2pDriver& good, const P2pBlock& block, const Bytes& frame, PlcMemory& memory) {
             std::vector<Value> kept;
             for (const p2p::P2pVariable& variable : block.variables)
               kept.push_back(memory.read(variable.own));
             const auto error = good.take(block, frame, memory);
             for (std::size_t i = 1; i < kept.size(); ++i)
               memory.write(block.variables[i].own, kept[i]);
             return error;
           }),
       "xgt_cnet/client/read/four_words", "%MW119 holds 135724689BDF5ABC7531FDB9"},
      {"saves_run_one_short", "the last element of a run is not saved",
       takes(
           [](const P2pDriver& good, const P2pBlock& block, const Bytes& frame, PlcMemory& memory) {
             const plc::DeviceAddress last = block.variables[0].own + (block.elements() - 1);
             const Value kept = memory.read(last);
             const auto error = good.take(block, frame, memory);
             if (block.continuous) memory.write(last, kept);
             return error;
           }),
       "xgt_cnet/client/run/read/words", "%MW119 holds 13575ABC9BDF86427531FDB9"},
      {"saves_in_the_first_place",
       "variables are saved behind the first, not each in its own place",
       each_block([](P2pBlock& block) {
         for (std::size_t i = 0; reads(block) && i < block.variables.size(); ++i)
           block.variables[i].own = block.variables[0].own + static_cast<std::uint32_t>(i);
       }),
       "xgt_cnet/client/read/four_words", "%MW119 holds 135724689BDF5ABC6BCD7CDE"},
      {"saves_before_judging", "data are saved although the reply is refused", takes(save_first),
       "xgt_cnet/client/error/all_or_nothing/not_hex", "%MW119 holds 13575ABC9BDF86427531FDB9"},
      {"saves_nak", "the code of a NAK is saved as data", takes(save_nak), "xgt_cnet/client/nak",
       "%MW199 holds 135711329BDF"},
      {"nak_is_normal", "NAK is a normal end",
       instead_of(p2p::p2p_error::nak, p2p::p2p_error::none), "xgt_cnet/client/nak",
       "%LW512 holds 0001"},
      {"foreign_station", "the reply of another station is accepted",
       understands_xgt(
           [](XgtReply& reply, const P2pBlock& block) { reply.station = block.station; }),
       "xgt_cnet/client/error/wrong_station/next", "%MW119 holds 13575ABC9BDF86427531FDB9"},
      {"foreign_station_ignored", "the reply of another station does not end the wait",
       takes(ignore_wrong), "xgt_cnet/client/error/wrong_station/next", "%LW512 holds 0000"},
      {"check_ignored", "a wrong BCC is accepted", hears(accept_any_check),
       "xgt_cnet/client/error/wrong_bcc/wrong", "%MW119 holds 13575ABC9BDF86427531FDB9"},
      {"bcc_first_digit_alone", "of the BCC the first digit alone is compared",
       hears(accept_first_digit), "xgt_cnet/client/error/wrong_bcc/wrong",
       "%MW119 holds 13575ABC9BDF86427531FDB9"},
      {"bcc_second_digit_alone", "of the BCC the second digit alone is compared",
       hears(accept_second_digit), "xgt_cnet/client/error/wrong_bcc/first_digit",
       "%MW119 holds 13575ABC9BDF86427531FDB9"},
      {"command_ignored", "a reply that repeats another command is accepted",
       understands_xgt([](XgtReply& reply, const P2pBlock& block) {
         reply.command = reads(block) ? 'r' : 'w';
         reply.kind = block.continuous ? "SB" : "SS";
       }),
       "xgt_cnet/client/error/wrong_driver/run", "%MW119 holds 13575ABC9BDF86427531FDB9"},
      {"surplus_ignored", "a reply with too many values is accepted",
       understands_xgt([](XgtReply& reply, const P2pBlock& block) {
         for (std::string_view& data : reply.data)
           data = data.substr(0, std::size_t{2} * plc::type_bytes(block.type) * block.elements());
       }),
       "xgt_cnet/client/error/length/long", "%MW119 holds 13575ABC9BDF86427531FDB9"},
      {"not_hex_is_a_wrong_length", "data that are not hex are 0B, not 0D",
       instead_of(p2p::p2p_error::not_hex, p2p::p2p_error::length),
       "xgt_cnet/client/error/not_hex/first", "%LW513 holds 000B"},
      {"range_is_a_wrong_length", "what runs over the end of the save area is 0B, not 0E",
       instead_of(p2p::p2p_error::range, p2p::p2p_error::length),
       "xgt_cnet/client/error/range/xbc_m", "%LW513 holds 000B"},
  };
}

}  // namespace fieldproof::p2p_broken
