// Faults in what is read and written: order of bytes and words, addresses, rights (Cnet EN 7.1.4).
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "suites/xgt_cnet/broken/faults.hpp"

namespace fieldproof::xgt_cnet_broken {

using xgt_cnet::XgtRequest;
using xgt_cnet::XgtService;

namespace {

char type_of(const XgtRequest& request) {
  return request.blocks > 0 && request.block[0].name.size() > 2 ? request.block[0].name[2] : '\0';
}

/// Cuts digits into groups and puts the `part`s of each group in reverse order.
std::string reversed(std::string_view digits, std::size_t group, std::size_t part) {
  std::string out;
  for (std::size_t at = 0; at < digits.size(); at += group) {
    const std::string_view one = digits.substr(at, group);
    for (std::size_t end = one.size(); end >= part; end -= part)
      out += one.substr(end - part, part);
  }
  return out;
}

struct Order {
  char type;          // of the names it applies to
  std::size_t group;  // digits
  std::size_t part;
};
constexpr Order word_bytes{'W', 4, 2}, dword_halves{'D', 8, 4}, lword_quarters{'L', 16, 4};

Bytes reordered_write(const Bytes& frame, const Order& order) {
  XgtRequest request = xgt_cnet::parse_request(frame);
  if (request.fault || type_of(request) != order.type || (request.command | 0x20) != 'w')
    return frame;
  std::array<std::string, xgt_cnet::xgt_max_blocks> data;
  for (unsigned i = 0; i < request.blocks; ++i) {
    data[i] = reversed(request.block[i].data, order.group, order.part);
    request.block[i].data = data[i];
  }
  Bytes out;
  xgt_cnet::encode_request(request, out);
  return out;
}

Bytes reordered_read(const Bytes& frame, Bytes reply_bytes, const Order& order) {
  const XgtRequest request = xgt_cnet::parse_request(frame);
  xgt_cnet::XgtReply reply = xgt_cnet::parse_reply(reply_bytes);
  if (reply_bytes.empty() || type_of(request) != order.type || (request.command | 0x20) != 'r' ||
      !reply.ack)
    return reply_bytes;
  std::array<std::string, xgt_cnet::xgt_max_blocks> data;
  for (unsigned i = 0; i < reply.blocks; ++i) {
    data[i] = reversed(reply.data[i], order.group, order.part);
    reply.data[i] = data[i];
  }
  Bytes out;
  xgt_cnet::encode_reply(reply, out);
  return out;
}

MakeBehaviour reorder(Order order, bool reads, bool writes) {
  return answer_with([=](const Bytes& request, GoodPlc& plc) {
    Bytes reply = plc.answer(writes ? reordered_write(request, order) : request);
    return reads ? reordered_read(request, std::move(reply), order) : reply;
  });
}

/// Understands one type's numbers differently.
MakeBehaviour renumber(char type, std::uint32_t (*number)(std::uint32_t)) {
  return misread([type, number](const Bytes& request, GoodPlc&) {
    return with_names(request, [type, number](std::string name) {
      const NameParts parts = split_name(name);
      return parts.number && name[2] == type
                 ? parts.area_and_type + std::to_string(number(*parts.number))
                 : name;
    });
  });
}

/// %MX1A becomes %MX15: bit 15 is counted as bit 0.
std::string mirrored_bit(std::string name) {
  if (name.size() < 4 || name[2] != 'X' || name[1] == 'T' || name[1] == 'C') return name;
  const int bit = hex_digit(name.back());
  if (bit >= 0) name.back() = hex_char(static_cast<unsigned>(15 - bit));
  return name;
}

bool is_contact(std::string_view name) {
  return name.size() > 3 && name[2] == 'X' && (name[1] == 'T' || name[1] == 'C');
}

/// One block: the contact is on where the current value is not 0, and writing it writes the value.
Bytes contact_of_value(const Bytes& frame, GoodPlc& plc) {
  const XgtRequest request = xgt_cnet::parse_request(frame);
  Bytes reply = plc.answer(frame);
  if (request.blocks != 1 || !is_contact(request.block[0].name) || reply.empty() ||
      reply[0] != xgt_cnet::xgt_ack)
    return reply;
  const std::string value =
      fmt::format("%{}W{}", request.block[0].name[1], request.block[0].name.substr(3));
  if ((request.command | 0x20) == 'w') {
    (void)plc.memory().set(value, "00" + std::string(request.block[0].data));
    return reply;
  }
  const Result<std::string> held = plc.memory().get(value, 0);
  return ack_to(request, held && *held != "0000" ? "010101" : "010100");
}

/// Writes what it should refuse with 1132.
Bytes write_read_only(const Bytes& frame, GoodPlc& plc) {
  const XgtRequest request = xgt_cnet::parse_request(frame);
  Bytes reply = plc.answer(frame);
  if (refusal(reply) != xgt_cnet::xgt_error::area || (request.command | 0x20) != 'w') return reply;
  for (unsigned i = 0; i < request.blocks; ++i)
    if (!plc.memory().set(request.block[i].name, request.block[i].data)) return reply;
  return ack_to(request);
}

/// Checks each block as it writes it.
Bytes write_until_refused(const Bytes& frame, GoodPlc& plc) {
  const XgtRequest request = xgt_cnet::parse_request(frame);
  Bytes reply = plc.answer(frame);
  if (!refusal(reply) || request.service != XgtService::write_blocks) return reply;
  for (unsigned i = 0; i < request.blocks; ++i) {
    XgtRequest one = request;
    one.blocks = 1;
    one.block[0] = request.block[i];
    Bytes single;
    xgt_cnet::encode_request(one, single);
    if (refusal(plc.answer(single))) return reply;
  }
  return reply;
}

Bytes write_up_to_the_end(const Bytes& frame, GoodPlc& plc) {
  XgtRequest request = xgt_cnet::parse_request(frame);
  Bytes reply = plc.answer(frame);
  if (refusal(reply) != xgt_cnet::xgt_error::range || request.service != XgtService::write_run)
    return reply;
  const std::size_t digits = 2 * plc::type_bytes(type_of(request));
  while (--request.count > 0 && request.block[0].data.size() > digits) {
    request.block[0].data.remove_suffix(digits);
    Bytes shorter;
    xgt_cnet::encode_request(request, shorter);
    if (!refusal(plc.answer(shorter))) break;
  }
  return reply;
}

Bytes write_unanswered(const Bytes& frame, GoodPlc& plc) {
  const Bytes reply = plc.answer(frame);
  FrameText text = take_apart(frame);
  text.seal();
  if (reply.empty() && text.service()[0] == 'W') (void)plc.answer(text.bytes());
  return reply;
}

Bytes write_for_others(const Bytes& frame, GoodPlc& plc) {
  const Bytes reply = plc.answer(frame);
  FrameText text = take_apart(frame);
  if (!reply.empty() || text.service()[0] != 'W') return reply;
  text.body.replace(0, 2, hex_number(plc.station(), 2));
  text.seal();
  (void)plc.answer(text.bytes());
  return reply;
}

/// A bit whose value is neither 00 nor 01 is refused, and on all the same.
Bytes set_refused_bit(const Bytes& frame, GoodPlc& plc) {
  const XgtRequest request = xgt_cnet::parse_request(frame);
  Bytes reply = plc.answer(frame);
  if (refusal(reply) == xgt_cnet::xgt_error::data && type_of(request) == 'X')
    (void)plc.memory().set(request.block[0].name, "01");
  return reply;
}

/// Every write is acknowledged, and nothing happens.
Bytes acknowledge_only(const Bytes& frame, GoodPlc& plc) {
  const XgtRequest request = xgt_cnet::parse_request(frame);
  if (request.service != XgtService::write_run || request.station != plc.station() || request.fault)
    return plc.answer(frame);
  return ack_to(request);
}

/// The neighbour byte is cleared by a write of one byte.
Bytes clear_other_byte(const Bytes& frame, GoodPlc& plc) {
  const XgtRequest request = xgt_cnet::parse_request(frame);
  Bytes reply = plc.answer(frame);
  if (request.service != XgtService::write_blocks || type_of(request) != 'B' || reply.empty() ||
      reply[0] != xgt_cnet::xgt_ack)
    return reply;
  for (unsigned i = 0; i < request.blocks; ++i) {
    const NameParts parts = split_name(request.block[i].name);
    if (parts.number)
      (void)plc.memory().set(parts.area_and_type + std::to_string(*parts.number ^ 1), "00");
  }
  return reply;
}

/// Writing one bit clears the other bits of its word. Names of XBM and XBC.
Bytes clear_other_bits(const Bytes& frame, GoodPlc& plc) {
  const XgtRequest request = xgt_cnet::parse_request(frame);
  if (request.service == XgtService::write_blocks && type_of(request) == 'X' &&
      !refusal(plc.answer(frame))) {
    const std::string_view name = request.block[0].name;
    const std::string word = name.size() > 4 ? std::string(name.substr(3, name.size() - 4)) : "0";
    if (!is_contact(name)) (void)plc.memory().set(fmt::format("%{}W{}", name[1], word), "0000");
  }
  return plc.answer(frame);
}

/// An area under the name of another.
std::string area_for(std::string name, char from, char to) {
  if (name.size() > 1 && name[1] == from) name[1] = to;
  return name;
}

}  // namespace

std::vector<Fault> data_faults() {
  return {
      {"word_bytes_swapped_in_reads", "words are read with the low byte first",
       reorder(word_bytes, true, false), "rss/two_words/lower", "data"},
      {"word_bytes_swapped_in_writes", "words are written with the low byte first",
       reorder(word_bytes, false, true), "wss/type_word/lower", "is due"},
      {"word_bytes_swapped_in_both",
       "words are read and written with the low byte first: it cancels where words are read back "
       "as words",
       reorder(word_bytes, true, true), "wss/value_1234_is_31323334/lower", "%MB200"},
      {"dword_halves_swapped", "dwords are read and written with the low word first",
       reorder(dword_halves, true, true), "wss/type_dword/lower", "is due"},
      {"lword_quarters_reversed", "lwords are read and written with the lowest word first",
       reorder(lword_quarters, true, true), "wss/type_lword/lower", "is due"},
      {"bytes_swapped", "an even byte address is the high byte",
       renumber('B', [](std::uint32_t n) { return n ^ 1; }), "data_types/bytes_read_as_words/lower",
       "data"},
      {"odd_byte_is_the_even_one", "an odd byte address reads and writes the low byte",
       renumber('B', [](std::uint32_t n) { return n & ~1u; }), "rsb/bytes_from_an_odd_one/lower/01",
       "data"},
      {"byte_address_not_doubled", "a byte address counts words",
       renumber('B', [](std::uint32_t n) { return n * 2; }),
       "data_types/byte_address_is_doubled/lower/k/20", "data"},
      {"dword_address_in_words", "a dword address counts words",
       renumber('D', [](std::uint32_t n) { return n / 2; }),
       "data_types/dword_and_lword_numbers/lower/d1", "data"},
      {"bit_order_reversed", "bit 0 is the highest bit of a word",
       misread([](const Bytes& request, GoodPlc&) { return with_names(request, mirrored_bit); }),
       "data_types/bits_of_a_word/lower/2", "data"},
      {"bit_is_ff", "a bit that is on reads FF",
       edit_reply([](FrameText& reply, const FrameText& request) {
         if (reply.is_ack() && request.service() == "RSS" &&
             request.content().find("X") != std::string::npos && reply.content() == "010101")
           reply.body = reply.front() + "0101FF";
       }),
       "rss/bit_is_00_or_01/lower/on_2", "data"},
      {"contacts_alias_values", "the contact of a timer or counter is its current value",
       answer_with(contact_of_value), "data_types/contact_against_value/lower/t/off", "data"},
      {"writes_read_only_areas", "F and N can be written", answer_with(write_read_only),
       "wss/read_only_areas_without_memory/f", "header"},
      {"sets_a_refused_bit", "a bit is on after a value that was refused as none of a bit",
       answer_with(set_refused_bit), "wss/bit_value_wrong/n11_lower", "is due"},
      {"writes_first_blocks_of_a_refused_write",
       "a refused WSS has written the blocks before the wrong one",
       answer_with(write_until_refused), "wss/all_or_nothing/area_lower", "is due"},
      {"refused_wsb_writes_its_beginning", "a WSB that leaves the area has written up to the end",
       answer_with(write_up_to_the_end), "areas/continuous_write_across_the_end/xbc_h_m", "is due"},
      {"wrong_bcc_writes", "a write with a wrong BCC is not answered, but executed",
       answer_with(write_unanswered), "wss/wrong_bcc", "is due"},
      {"foreign_station_writes", "a write to another station is not answered, but executed",
       answer_with(write_for_others), "wss/other_station/lower", "is due"},
      {"wsb_writes_nothing", "WSB is acknowledged and writes nothing",
       answer_with(acknowledge_only), "wsb/five_words/lower", "is due"},
      {"bit_write_clears_its_word", "writing one bit clears the others of its word",
       answer_with(clear_other_bits), "wss/type_bit/xbc_h_set_lower", "is due"},
      {"areas_alias", "K is M under another name", misread([](const Bytes& request, GoodPlc&) {
         return with_names(request, [](std::string name) { return area_for(name, 'K', 'M'); });
       }),
       "rss/mixed_areas_words/lower/words", "data"},
      {"byte_write_clears_its_neighbour", "writing one byte clears the other byte of the word",
       answer_with(clear_other_byte), "wss/type_byte/even_lower", "is due"},
  };
}

}  // namespace fieldproof::xgt_cnet_broken
