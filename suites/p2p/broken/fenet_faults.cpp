// The XGT client of an Ethernet module (FEnet EN 5.2, 7.5): what it asks, and what it makes of a
// reply.
#include "suites/p2p/broken/faults.hpp"

#include <utility>

#include "src/xgt_fenet/client_body.hpp"
#include "src/xgt_fenet/header.hpp"

namespace fieldproof::p2p_broken {

using p2p::P2pBlock;
using p2p::P2pDriver;
using plc::PlcMemory;
using xgt_fenet::Header;
using xgt_fenet::header_size;
using xgt_fenet::Request;

namespace {

constexpr std::size_t type_at = 2, reserved_at = 4, status_at = 6, blocks_at = 8, data_at = 12;

/// Spoils requests of FEnet alone: another channel may speak another protocol.
MakeBehaviour spoils_own(std::function<void(Bytes& frame)> edit) {
  return spoils([=](Bytes& frame) {
    if (xgt_fenet::read_header(frame)) edit(frame);
  });
}

/// Sends another header.
MakeBehaviour header(std::function<void(Header& header)> edit) {
  return spoils_own([=](Bytes& frame) {
    Header own = *xgt_fenet::read_header(frame);
    edit(own);
    frame = xgt_fenet::encode_frame(own, ByteView(frame).subspan(header_size));
  });
}

/// Sends another body.
MakeBehaviour body(std::function<void(Bytes& body)> edit) {
  return spoils_own([=](Bytes& frame) {
    Bytes own(frame.begin() + header_size, frame.end());
    edit(own);
    frame = xgt_fenet::encode_frame(*xgt_fenet::read_header(frame), own);
  });
}

/// The same, as a request; the texts of the edit live until it is sent.
MakeBehaviour request(std::function<void(Request& request, std::vector<std::string>& texts)> edit) {
  return body([=](Bytes& bytes) {
    const Bytes right = bytes;
    Request own = xgt_fenet::parse_request(right);
    std::vector<std::string> texts;
    texts.reserve(own.blocks.size());
    edit(own, texts);
    bytes = xgt_fenet::encode_request(own);
  });
}

MakeBehaviour spells(std::function<std::string(std::string name)> edit) {
  return request([=](Request& own, std::vector<std::string>& texts) {
    for (Request::Block& block : own.blocks)
      block.name = texts.emplace_back(edit(std::string(block.name)));
  });
}

/// Takes another reply for that which came.
MakeBehaviour reply(std::function<void(Header& header, Bytes& body, const P2pBlock& block)> edit) {
  return hears([=](Bytes& frame, const P2pBlock& block) {
    std::optional<Header> own = xgt_fenet::read_header(frame);
    if (!own) return;
    Bytes content(frame.begin() + header_size, frame.end());
    edit(*own, content, block);
    frame = xgt_fenet::encode_frame(*own, content);
  });
}

void set_low_first(Bytes& bytes, std::size_t at, unsigned value) {
  if (bytes.size() < at + 2) return;
  bytes[at] = static_cast<Byte>(value);
  bytes[at + 1] = static_cast<Byte>(value >> 8);
}

/// The number of the last request, as it was sent.
struct Sent {
  std::uint16_t invoke = 0, before = 0;
};

/// A reply's number is made that of the request where `passes` says so.
Behaviour taken_by(std::function<bool(std::uint16_t came, const Sent& sent)> passes) {
  const auto sent = std::make_shared<Sent>();
  return {.asks =
              [=](P2pDriver& good, const P2pBlock& block, const PlcMemory& memory) {
                Result<Bytes> frame = good.request(block, memory);
                if (frame && xgt_fenet::read_header(*frame))
                  sent->before = std::exchange(sent->invoke, xgt_fenet::word_at(*frame, 14));
                return frame;
              },
          .takes =
              [=](const P2pDriver& good, const P2pBlock& block, Bytes frame, PlcMemory& memory) {
                const auto own = xgt_fenet::read_header(frame);
                if (own)
                  set_low_first(frame, 14, passes(own->invoke, *sent) ? sent->invoke : 0xFFFF);
                return good.take(block, frame, memory);
              }};
}

/// Each request has the number 1.
Behaviour does_not_count() {
  const auto sent = std::make_shared<std::uint16_t>(0);
  return {.asks =
              [=](P2pDriver& good, const P2pBlock& block, const PlcMemory& memory) {
                Result<Bytes> frame = good.request(block, memory);
                if (frame && xgt_fenet::read_header(*frame)) {
                  *sent = xgt_fenet::word_at(*frame, 14);
                  set_low_first(*frame, 14, 1);
                  frame->at(19) = xgt_fenet::header_check(*frame);
                }
                return frame;
              },
          .takes =
              [=](const P2pDriver& good, const P2pBlock& block, Bytes frame, PlcMemory& memory) {
                const auto own = xgt_fenet::read_header(frame);
                if (own) set_low_first(frame, 14, own->invoke == 1 ? *sent : 0xFFFF);
                return good.take(block, frame, memory);
              }};
}

void reverse_data(Bytes& bytes) {
  if (bytes.size() <= data_at || xgt_fenet::word_at(bytes, type_at) == 0x14) return;
  std::reverse(bytes.begin() + data_at, bytes.end());
}

/// A run named and counted by its own elements.
MakeBehaviour run_of(unsigned size, std::string_view letter, bool counts_elements) {
  return request([=](Request& own, std::vector<std::string>& texts) {
    if (!own.is_continuous()) return;
    Request::Block& block = own.blocks.front();
    const unsigned index = static_cast<unsigned>(std::stoul(std::string(block.name.substr(3))));
    block.name = texts.emplace_back(std::string(block.name.substr(0, 2)) + std::string(letter) +
                                    std::to_string(index / size));
    if (counts_elements) block.size = static_cast<std::uint16_t>(block.size / size);
  });
}

/// Each name has its data behind it.
void interleave(Bytes& bytes) {
  const Bytes right = bytes;
  const Request own = xgt_fenet::parse_request(right);
  if (!own.writes()) return;
  bytes.resize(blocks_at);
  for (const Request::Block& block : own.blocks) {
    xgt_fenet::put_word(bytes, block.name.size());
    bytes.insert(bytes.end(), block.name.begin(), block.name.end());
    xgt_fenet::put_word(bytes, block.size);
    bytes.insert(bytes.end(), block.data.begin(), block.data.end());
  }
}

/// The good driver's judgement, where it refuses with `from`, is another.
MakeBehaviour refusal(std::function<std::uint16_t(std::uint16_t code)> shown) {
  return takes([=](const P2pDriver& good, const P2pBlock& block, const Bytes& frame,
                   PlcMemory& memory) -> std::optional<std::uint16_t> {
    const auto error = good.take(block, frame, memory);
    const bool refused =
        frame.size() == header_size + 10 && xgt_fenet::word_at(frame, header_size + status_at) != 0;
    return error && refused ? shown(*error) : error;
  });
}

/// Data are saved by way of 256 bytes, which the rest of a longer reply finds as it left them.
void wraps_at_256(Header&, Bytes& content, const P2pBlock&) {
  constexpr std::size_t ring = 256;
  for (std::size_t i = data_at + ring; i < content.size(); ++i) content[i] = content[i - ring];
}

void with_the_command_asked_for(Header&, Bytes& content, const P2pBlock& block) {
  const bool writes = block.function == P2pBlock::Function::write;
  set_low_first(content, 0, writes ? 0x59 : 0x55);
}

}  // namespace

std::vector<Fault> fenet_request_faults() {
  return {
      {"fenet_company_glofa", "requests have the company id LGIS-GLOFA",
       header([](Header& own) { own.company = xgt_fenet::lgis_glofa; }),
       "xgt_fenet/client/read/header", "company id: expected"},
      {"fenet_company_without_zeros", "the company id ends with spaces",
       header([](Header& own) { own.company[8] = own.company[9] = ' '; }),
       "xgt_fenet/client/read/header", "company id: expected"},
      {"fenet_plc_info", "requests have a PLC info",
       header([](Header& own) { own.plc_info = 0x107; }), "xgt_fenet/client/read/header",
       "PLC info: expected"},
      {"fenet_source_of_server", "requests come from a server",
       header([](Header& own) { own.source = xgt_fenet::from_server; }),
       "xgt_fenet/client/read/header", "source: expected"},
      {"fenet_length_with_header", "the length counts the header, too",
       spoils_own(
           [](Bytes& frame) { set_low_first(frame, 16, static_cast<unsigned>(frame.size())); }),
       "xgt_fenet/client/read/single/word", "length: expected"},
      {"fenet_length_high_byte_first", "the length stands high byte first",
       spoils_own([](Bytes& frame) { std::swap(frame.at(16), frame.at(17)); }),
       "xgt_fenet/client/read/single/word", "length: expected"},
      {"fenet_sum_of_all", "the check sum is that of header and body", spoils_own([](Bytes& frame) {
         for (std::size_t i = header_size; i < frame.size(); ++i)
           frame.at(19) = static_cast<Byte>(frame.at(19) + frame[i]);
       }),
       "xgt_fenet/client/read/check_sum", "check sum: expected"},
      {"fenet_no_sum", "the check sum is left 0",
       spoils_own([](Bytes& frame) { frame.at(19) = 0; }), "xgt_fenet/client/read/check_sum",
       "check sum: expected"},
      {"fenet_invoke_not_counted", "each request has the same invoke id", does_not_count,
       "xgt_fenet/client/errors/previous_reply", "%MW120 holds 6BCD"},
      {"fenet_command_high_byte_first", "the command stands high byte first",
       body([](Bytes& bytes) { std::swap(bytes.at(0), bytes.at(1)); }),
       "xgt_fenet/client/read/single/word", "command: expected"},
      {"fenet_word_for_every_type", "the data type is word whatever the block's is",
       body([](Bytes& bytes) {
         if (bytes.at(type_at) != 0x14) bytes.at(type_at) = 2;
       }),
       "xgt_fenet/client/read/single_long/dword", "data type: expected"},
      {"fenet_reserved_word", "the reserved word of the body is not 0",
       body([](Bytes& bytes) { set_low_first(bytes, reserved_at, 1); }),
       "xgt_fenet/client/read/single/word", "reserved: expected"},
      {"fenet_one_block", "the number of blocks is 1 whatever it is",
       body([](Bytes& bytes) { set_low_first(bytes, 6, 1); }), "xgt_fenet/client/read/areas_3",
       "block count: expected"},
      {"fenet_names_in_reverse", "the last name is asked for first",
       request([](Request& own, auto&) {
         if (!own.writes()) std::ranges::reverse(own.blocks);
       }),
       "xgt_fenet/client/read/areas_2", "name length 1: expected 0600, got 0400"},
      {"fenet_names_padded", "names have five digits", spells([](std::string name) {
         return name.substr(0, 3) + std::string(8 - std::min<std::size_t>(8, name.size()), '0') +
                name.substr(3);
       }),
       "xgt_fenet/client/read/single/word", "name"},
      {"fenet_names_in_lower_case", "names are in lower case", spells([](std::string name) {
         for (char& c : name) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
         return name;
       }),
       "xgt_fenet/client/read/single/word", "name: expected"},
      {"fenet_name_without_percent", "names have no %",
       spells([](std::string name) { return name.substr(1); }), "xgt_fenet/client/read/single/word",
       "length: expected 1000 (16 bytes), got 0F00"},
      {"fenet_name_length_high_byte_first", "the length of a name stands high byte first",
       body([](Bytes& bytes) { std::swap(bytes.at(8), bytes.at(9)); }),
       "xgt_fenet/client/read/single/word", "name length: expected"},
      {"fenet_run_by_words", "a run of words is named and counted by words", run_of(2, "W", true),
       "xgt_fenet/client/read/continuous_word", "name: expected"},
      {"fenet_run_counted_by_words", "a run of words counts words, not bytes",
       request([](Request& own, auto&) {
         if (own.is_continuous() && !own.writes()) own.blocks.front().size /= 2;
       }),
       "xgt_fenet/client/read/continuous_word", "number of data: expected"},
      {"fenet_run_address_not_doubled", "a run of words is named by the byte of its word's number",
       run_of(2, "B", false), "xgt_fenet/client/read/continuous_word", "name: expected"},
      {"fenet_run_as_individual", "a run of bytes is asked for as an individual one",
       body([](Bytes& bytes) {
         if (bytes.at(type_at) == 0x14) bytes.at(type_at) = 1;
       }),
       "xgt_fenet/client/read/continuous_two", "data type: expected"},
      {"fenet_write_as_read", "a write is sent as a read",
       body([](Bytes& bytes) { bytes.at(0) = 0x54; }), "xgt_fenet/client/write/single/word",
       "command: expected"},
      {"fenet_write_high_byte_first", "what is written goes out high byte first",
       body([](Bytes& bytes) {
         if (bytes.at(0) == 0x58) std::swap(bytes.at(bytes.size() - 1), bytes.at(bytes.size() - 2));
       }),
       "xgt_fenet/client/write/single/word", "data: expected"},
      {"fenet_write_interleaved", "each name that is written has its data behind it",
       body(interleave), "xgt_fenet/client/write/areas_2",
       "name length 2: expected 0400, got 0200"},
      {"fenet_bit_as_ff", "a bit that is on is written as FF", body([](Bytes& bytes) {
         if (bytes.at(0) == 0x58 && bytes.at(type_at) == 0 && bytes.back() == 1)
           bytes.back() = 0xFF;
       }),
       "xgt_fenet/client/write/bit/on", "data: expected"},
      {"fenet_writes_the_first_value", "a write sends what memory held at the first time",
       [] {
         return Behaviour{
             .asks = [kept = std::make_shared<std::optional<PlcMemory>>()](
                         P2pDriver& good, const P2pBlock& block, const PlcMemory& memory) {
               if (!*kept) {
                 kept->emplace(memory.model());
                 for (const auto& variable : block.variables)
                   (*kept)->write(variable.own, memory.read(variable.own));
               }
               return good.request(block, **kept);
             }};
       },
       "xgt_fenet/client/write/value_of_the_edge", "data: expected"},
  };
}

std::vector<Fault> fenet_reply_faults() {
  return {
      {"fenet_any_invoke", "a reply is taken whatever its invoke id is",
       [] { return taken_by([](std::uint16_t, const Sent&) { return true; }); },
       "xgt_fenet/client/errors/wrong_invoke", "%MW119 holds 13576BCD9BDF86427531FDB9"},
      {"fenet_previous_invoke", "the reply to the request before is taken, too",
       [] {
         return taken_by([](std::uint16_t came, const Sent& sent) {
           return came == sent.invoke || came == sent.before;
         });
       },
       "xgt_fenet/client/errors/other_block", "%MW119 holds 13575ABC9BDF6BCD7531FDB9"},
      {"fenet_invoke_high_byte_first", "the invoke id of a reply is read high byte first",
       [] {
         return taken_by([](std::uint16_t came, const Sent& sent) {
           return came == static_cast<std::uint16_t>(sent.invoke << 8 | sent.invoke >> 8);
         });
       },
       "xgt_fenet/client/read/single/word", "%MW119 holds 135724689BDF86427531FDB9"},
      {"fenet_any_company", "a reply of another company is taken",
       reply([](Header& own, Bytes&, const P2pBlock&) { own.company = xgt_fenet::lsis_xgt; }),
       "xgt_fenet/client/errors/company_id/unknown", "%MW119 holds 13576BCD9BDF86427531FDB9"},
      {"fenet_any_source", "a reply is taken whoever it comes from",
       reply([](Header& own, Bytes&, const P2pBlock&) { own.source = xgt_fenet::from_server; }),
       "xgt_fenet/client/errors/source", "%MW119 holds 13576BCD9BDF86427531FDB9"},
      {"fenet_position_compared", "only replies of base 0, slot 1 are taken",
       takes([](const P2pDriver& good, const P2pBlock& block, const Bytes& frame,
                PlcMemory& memory) -> std::optional<std::uint16_t> {
         if (frame.size() > 18 && frame[18] > 1) return std::nullopt;
         return good.take(block, frame, memory);
       }),
       "xgt_fenet/client/read/reply_header/position", "%MW119 holds 135724689BDF86427531FDB9"},
      {"fenet_stop_is_an_error", "a server in STOP gives no data",
       takes([](const P2pDriver& good, const P2pBlock& block, const Bytes& frame,
                PlcMemory& memory) -> std::optional<std::uint16_t> {
         if (frame.size() > 11 && frame[11] == 2) return p2p::p2p_error::nak;
         return good.take(block, frame, memory);
       }),
       "xgt_fenet/client/read/reply_header/stop", "%MW119 holds 135724689BDF86427531FDB9"},
      {"fenet_reserved_compared", "a reply with a reserved word other than 0 is refused",
       takes([](const P2pDriver& good, const P2pBlock& block, const Bytes& frame,
                PlcMemory& memory) -> std::optional<std::uint16_t> {
         const std::size_t at = header_size + reserved_at;
         if (frame.size() > at + 1 && xgt_fenet::word_at(frame, at) != 0)
           return p2p::p2p_error::driver;
         return good.take(block, frame, memory);
       }),
       "xgt_fenet/client/read/example_individual", "%MW119 holds 135724689BDF86427531FDB9"},
      {"fenet_command_not_compared", "a reply to another command is taken",
       reply(with_the_command_asked_for), "xgt_fenet/client/errors/body/command_54",
       "%MW119 holds 13576BCD9BDF86427531FDB9"},
      {"fenet_wraps_at_256", "what a reply has behind its 256th byte is what it has 256 before",
       reply(wraps_at_256), "xgt_fenet/client/limits/bytes_512", "%MW"},
      {"fenet_type_not_compared", "a reply of another data type is taken",
       reply([](Header&, Bytes& content, const P2pBlock&) { set_low_first(content, type_at, 2); }),
       "xgt_fenet/client/errors/body/data_type", "%MW119 holds 13576BCD9BDF86427531FDB9"},
      {"fenet_blocks_not_compared", "a reply with too many blocks is taken",
       reply([](Header&, Bytes& content, const P2pBlock& block) {
         if (content.size() < data_at || block.variables.size() != 1) return;
         set_low_first(content, blocks_at, 1);
         content.resize(data_at + 2);
       }),
       "xgt_fenet/client/errors/body/two_blocks", "%MW119 holds 13576BCD9BDF86427531FDB9"},
      {"fenet_size_not_compared", "of a block that is too long the first bytes are saved",
       reply([](Header&, Bytes& content, const P2pBlock& block) {
         if (content.size() <= data_at + 2 || block.variables.size() != 1) return;
         set_low_first(content, 10, 2);
         content.resize(data_at + 2);
       }),
       "xgt_fenet/client/errors/body/four_bytes", "%MW119 holds 13576BCD9BDF86427531FDB9"},
      {"fenet_surplus_ignored", "bytes behind the last block are passed over",
       reply([](Header&, Bytes& content, const P2pBlock& block) {
         const bool one = content.size() > data_at && content[blocks_at] == 1;
         if (one && content[10] == 2 && block.variables.size() == 1) content.resize(data_at + 2);
       }),
       "xgt_fenet/client/errors/body/surplus", "%MW119 holds 13576BCD9BDF86427531FDB9"},
      {"fenet_read_high_byte_first", "what is read is saved high byte first",
       reply([](Header&, Bytes& content, const P2pBlock&) { reverse_data(content); }),
       "xgt_fenet/client/read/single/word", "%MW119 holds 1357BC5A9BDF86427531FDB9"},
      {"fenet_refusal_is_normal", "a refusal is a normal end",
       refusal([](std::uint16_t) { return p2p::p2p_error::none; }),
       "xgt_fenet/client/errors/nak/c0004", "%LW512 holds 0001"},
      {"fenet_refusal_without_code", "STATUS of a refusal is 0F, whatever the server says",
       refusal([](std::uint16_t) { return p2p::p2p_error::nak; }),
       "xgt_fenet/client/errors/nak/c0004", "%LW513 holds 000F"},
      {"fenet_code_high_byte_first", "the code of a refusal is read high byte first",
       refusal(
           [](std::uint16_t code) { return static_cast<std::uint16_t>(code << 8 | code >> 8); }),
       "xgt_fenet/client/errors/nak/c1234", "%LW513 holds 3412"},
      {"fenet_code_of_one_byte", "of the code of a refusal only the low byte is kept",
       refusal([](std::uint16_t code) { return static_cast<std::uint16_t>(code & 0xFF); }),
       "xgt_fenet/client/errors/nak/c1234", "%LW513 holds 0034"},
      {"fenet_refusal_saved", "the code of a refusal is saved as data",
       takes(
           [](const P2pDriver& good, const P2pBlock& block, const Bytes& frame, PlcMemory& memory) {
             const auto error = good.take(block, frame, memory);
             const std::size_t at = header_size + blocks_at;
             if (error && *error != 0 && frame.size() == at + 2)
               memory.write(block.variables[0].own, xgt_fenet::word_at(frame, at));
             return error;
           }),
       "xgt_fenet/client/errors/nak/c0004", "%MW119 holds 135700049BDF86427531FDB9"},
      {"fenet_write_reply_not_looked_at", "any reply to a write is a normal end",
       takes([](const P2pDriver& good, const P2pBlock& block, const Bytes& frame,
                PlcMemory& memory) {
         const auto error = good.take(block, frame, memory);
         return error && block.function == P2pBlock::Function::write ? p2p::p2p_error::none : error;
       }),
       "xgt_fenet/client/errors/write_reply/two_blocks", "%LW512 holds 0001"},
  };
}

}  // namespace fieldproof::p2p_broken
