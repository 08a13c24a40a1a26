// Faults of data: order of bytes, bits and blocks, what is written and where (FEnet EN 5.2.4,
// 5.2.5).
#include <algorithm>

#include "suites/xgt_fenet/broken/faults.hpp"

namespace fieldproof::xgt_fenet_broken {

namespace {

/// Changes the data of each block of replies to individual reads of elements of `size` bytes.
MakeBehaviour read_data(std::size_t size, void (*change)(Byte* first, Byte* last)) {
  return edits([=](Bytes& reply, const Bytes& request) {
    if (is_refusal(reply) || !is_read(request) || is_continuous(request)) return;
    for (const Name& block : data_of(reply))
      if (block.size == size) change(&reply[block.at], &reply[block.at] + block.size);
  });
}
/// The same of what is written.
MakeBehaviour written_data(std::size_t size, void (*change)(Byte* first, Byte* last)) {
  return misreads([=](Bytes request) {
    if (!is_write(request) || is_continuous(request)) return request;
    for (const Name& block : data_of(request))
      if (block.size == size) change(&request[block.at], &request[block.at] + block.size);
    return request;
  });
}
void reversed(Byte* first, Byte* last) { std::reverse(first, last); }
void words_swapped(Byte* first, Byte* last) {
  for (Byte *a = first, *b = last - 2; a < b; a += 2, b -= 2) std::swap_ranges(a, a + 2, b);
}

/// Changes the characters of each name of a request of type `letter`.
MakeBehaviour renames(char letter, std::function<std::string(std::string)> change) {
  return misreads([=](Bytes request) {
    for (const Name& name : names_of(request)) {
      const auto begin = request.begin() + static_cast<std::ptrdiff_t>(name.at);
      const std::string text(begin, begin + static_cast<std::ptrdiff_t>(name.size));
      if (text.size() < 4 || text[2] != letter) continue;
      const std::string other = change(text);
      if (other.size() == text.size()) std::ranges::copy(other, begin);
    }
    return request;
  });
}
/// The memory of one area is that of another.
MakeBehaviour alias(char from, char to) {
  return misreads([=](Bytes request) {
    for (const Name& name : names_of(request))
      if (name.size > 1 && request[name.at + 1] == static_cast<Byte>(from))
        request[name.at + 1] = static_cast<Byte>(to);
    return request;
  });
}

/// The name's number `change`d, with as many digits.
std::function<std::string(std::string)> numbered(unsigned (*change)(unsigned)) {
  return [=](std::string name) {
    const std::string digits = name.substr(3);
    if (digits.find_first_not_of("0123456789") != digits.npos) return name;
    std::string other = std::to_string(change(static_cast<unsigned>(std::stoul(digits))));
    if (other.size() > digits.size()) return name;
    return name.substr(0, 3) + std::string(digits.size() - other.size(), '0') + other;
  };
}

/// Blocks of a reply in the reverse order.
void reverse_blocks(Bytes& reply, const Bytes& request) {
  if (is_refusal(reply) || !is_read(request)) return;
  std::vector<Name> blocks = data_of(reply);
  Bytes body(reply.begin(), reply.begin() + data_size_at);
  for (auto block = blocks.rbegin(); block != blocks.rend(); ++block)
    body.insert(body.end(), reply.begin() + static_cast<std::ptrdiff_t>(block->at - 2),
                reply.begin() + static_cast<std::ptrdiff_t>(block->at + block->size));
  reply = body;
}

/// The part of a write with the first half of its blocks alone; one block stays.
Bytes first_half(const Bytes& request) {
  const std::vector<Name> names = names_of(request), data = data_of(request);
  const std::size_t half = names.size() / 2;
  if (!is_write(request) || half == 0 || data.size() != names.size()) return request;
  Bytes part(request.begin(), request.begin() + name_length_at);
  const auto add = [&](const Name& one) {
    part.insert(part.end(), request.begin() + static_cast<std::ptrdiff_t>(one.at - 2),
                request.begin() + static_cast<std::ptrdiff_t>(one.at + one.size));
  };
  for (std::size_t i = 0; i < half; ++i) add(names[i]);
  for (std::size_t i = 0; i < half; ++i) add(data[i]);
  put_word(part, count_at, static_cast<unsigned>(half));
  put_word(part, length_at, static_cast<unsigned>(part.size() - body_at));
  return part;
}

/// Replies to reads with a changed word of the body.
MakeBehaviour reply_word(std::size_t at, unsigned (*change)(unsigned)) {
  return edits([=](Bytes& reply, const Bytes&) {
    if (!is_refusal(reply) && reply.size() > at + 1)
      put_word(reply, at, change(word_at(reply, at)));
  });
}

}  // namespace

std::vector<Fault> data_faults() {
  return {
      {"word_high_byte_first", "words are sent high byte first", read_data(2, reversed),
       "xgt_fenet/read/bytes_and_words/word", ""},
      {"dword_high_byte_first", "double words are sent high byte first", read_data(4, reversed),
       "xgt_fenet/read/dwords_and_lwords/dword", ""},
      {"dword_high_word_first", "double words are sent high word first",
       read_data(4, words_swapped), "xgt_fenet/read/dwords_and_lwords/dword", ""},
      {"lword_high_byte_first", "long words are sent high byte first", read_data(8, reversed),
       "xgt_fenet/read/dwords_and_lwords/lword", ""},
      {"lword_high_word_first", "long words are sent high word first", read_data(8, words_swapped),
       "xgt_fenet/read/dwords_and_lwords/lword", ""},
      {"written_word_swapped", "words are written high byte first", written_data(2, reversed),
       "xgt_fenet/write/bytes_and_words/word", ""},
      {"written_dword_swapped", "double words are written high word first",
       written_data(4, words_swapped), "xgt_fenet/write/dwords_and_lwords/dword", ""},
      {"written_lword_swapped", "long words are written high word first",
       written_data(8, words_swapped), "xgt_fenet/write/dwords_and_lwords/lword", ""},
      {"odd_bytes_first", "the high byte of a word has the even address",
       renames('B', numbered([](unsigned n) { return n ^ 1u; })),
       "xgt_fenet/read/bytes_and_words/low_byte", ""},
      {"bytes_by_words", "the address of a byte is that of a word",
       renames('B', numbered([](unsigned n) { return n / 2; })), "xgt_fenet/read/d1234", ""},
      {"dwords_by_words", "the address of a double word is that of a word",
       renames('D', numbered([](unsigned n) { return n / 2; })),
       "xgt_fenet/read/dwords_and_lwords/next_dword", ""},
      {"bits_from_the_top", "bit 0 is the highest one of a word",
       renames('X',
               [](std::string name) {
                 const int bit = hex_digit(name.back());
                 if (bit >= 0) name.back() = hex_char(static_cast<unsigned>(15 - bit));
                 return name;
               }),
       "xgt_fenet/read/bits/b0", ""},
      {"bits_of_bytes", "the bits of the two bytes of a word change places",
       renames('X',
               [](std::string name) {
                 const int bit = hex_digit(name.back());
                 if (bit >= 0) name.back() = hex_char(static_cast<unsigned>(bit ^ 8));
                 return name;
               }),
       "xgt_fenet/read/bits/b8", ""},
      {"bits_flat", "the bits of XBC count through, as those of XEC",
       renames('X',
               [](std::string name) {
                 const std::size_t digits = name.size() - 3;
                 const std::string text = name.substr(3);
                 if (text.find_first_not_of("0123456789") != text.npos) return name;
                 const unsigned flat = static_cast<unsigned>(std::stoul(text));
                 std::string other = std::to_string(flat / 16) + hex_char(flat % 16);
                 if (other.size() > digits) return name;
                 return name.substr(0, 3) + std::string(digits - other.size(), '0') + other;
               }),
       "xgt_fenet/read/bits/b0", ""},
      {"bit_reply_of_ff", "a bit that is on is sent as FF",
       edits([](Bytes& reply, const Bytes& request) {
         if (word_at(request, type_at) != 0 || is_refusal(reply) || !is_read(request)) return;
         for (const Name& block : data_of(reply))
           if (reply[block.at] == 1) reply[block.at] = 0xFF;
       }),
       "xgt_fenet/read/sixteen_bits", ""},
      {"bit_reply_of_two_bytes", "a bit has two bytes",
       edits([](Bytes& reply, const Bytes& request) {
         if (word_at(request, type_at) != 0 || is_refusal(reply) || !is_read(request)) return;
         if (data_of(reply).size() != 1) return;
         put_word(reply, data_size_at, 2);
         reply.push_back(0);
         put_word(reply, length_at, word_at(reply, length_at) + 1);
       }),
       "xgt_fenet/read/bits/b0", ""},
      {"any_value_is_on", "any value but 0 sets a bit", misreads([](Bytes request) {
         if (is_write(request) && word_at(request, type_at) == 0)
           for (const Name& block : data_of(request))
             if (block.size == 1) request[block.at] = request[block.at] != 0;
         return request;
       }),
       "xgt_fenet/write/bit_values/v02", ""},
      {"blocks_reversed", "the blocks of a reply are in the reverse order", edits(reverse_blocks),
       "xgt_fenet/read/block_counts/n2", ""},
      {"block_count_swapped", "the block count of replies is high byte first",
       reply_word(reply_blocks_at, swapped), "xgt_fenet/read/bytes_and_words/word", ""},
      {"block_count_of_bytes", "the block count of replies counts bytes",
       edits([](Bytes& reply, const Bytes& request) {
         if (!is_refusal(reply) && is_read(request))
           put_word(reply, reply_blocks_at, static_cast<unsigned>(reply.size() - data_size_at));
       }),
       "xgt_fenet/read/bytes_and_words/word", ""},
      {"block_count_of_write_lost", "replies to writes have block count 0",
       edits([](Bytes& reply, const Bytes& request) {
         if (!is_refusal(reply) && is_write(request)) put_word(reply, reply_blocks_at, 0);
       }),
       "xgt_fenet/write/block_counts/n2", ""},
      {"write_reply_without_count", "replies to writes end behind the status",
       edits([](Bytes& reply, const Bytes& request) {
         if (is_refusal(reply) || !is_write(request)) return;
         reply.resize(reply_blocks_at);
         put_word(reply, length_at, 8);
       }),
       "xgt_fenet/write/bytes_and_words/word", ""},
      {"data_size_swapped", "the size of data is high byte first",
       reply_word(data_size_at, swapped), "xgt_fenet/read/bytes_and_words/word", ""},
      {"data_size_of_words", "the size of data counts words",
       reply_word(data_size_at, [](unsigned n) { return n > 1 ? n / 2 : n; }),
       "xgt_fenet/continuous/read_counts/n4", ""},
      {"data_type_zero", "replies have data type 0000",
       reply_word(type_at, [](unsigned) { return 0u; }), "xgt_fenet/read/bytes_and_words/word", ""},
      {"run_as_individual", "replies to continuous reads have the data type of bytes",
       edits([](Bytes& reply, const Bytes& request) {
         if (!is_refusal(reply) && is_continuous(request)) put_word(reply, type_at, 1);
       }),
       "xgt_fenet/continuous/read_counts/n2", ""},
      {"reply_without_command", "replies repeat the command of the request",
       reply_word(command_at, [](unsigned command) { return command & ~1u; }),
       "xgt_fenet/read/bytes_and_words/word", ""},
      {"write_half_done", "of a write of several blocks the first half is done",
       misreads(first_half), "xgt_fenet/write/block_counts/n2", ""},
      {"refused_write_half_done", "a write that is refused has written its first blocks",
       [] {
         auto first = std::make_shared<Bytes>();
         return Behaviour{.hear = [](Burst heard, Server& server) {
           Bytes& bytes = heard.bytes;
           if (heard.event != LinkEvent::data || bytes.size() < name_at || !is_write(bytes))
             return Bursts{std::move(heard)};
           const std::vector<Name> names = names_of(bytes), data = data_of(bytes);
           for (std::size_t i = 0; i + 1 < names.size() && i < data.size(); ++i) {
             const std::string name(
                 bytes.begin() + static_cast<std::ptrdiff_t>(names[i].at),
                 bytes.begin() + static_cast<std::ptrdiff_t>(names[i].at + names[i].size));
             std::string hex;
             for (std::size_t b = data[i].size; b-- > 0;)
               hex += hex_number(bytes[data[i].at + b], 2);
             (void)server.plc.set(name, hex);
           }
           return Bursts{std::move(heard)};
         }};
       },
       "xgt_fenet/write/all_or_nothing/last_past_the_end", ""},
      {"run_shifted", "continuous reads begin a byte later", misreads([](Bytes request) {
         if (!is_read(request) || !is_continuous(request)) return request;
         for (const Name& name : names_of(request))
           if (name.size > 3 && request[name.at + name.size - 1] < '9')
             ++request[name.at + name.size - 1];
         return request;
       }),
       "xgt_fenet/continuous/as_individual", ""},
      {"run_from_even_addresses", "continuous requests begin at the low byte of a word",
       misreads([](Bytes request) {
         if (!is_continuous(request)) return request;
         for (const Name& name : names_of(request))
           if (name.size > 3) request[name.at + name.size - 1] &= 0xFE;
         return request;
       }),
       "xgt_fenet/continuous/read_addresses/b201_n1", ""},
      {"p_is_m", "P is the memory of M", alias('P', 'M'), "xgt_fenet/read/mixed_areas_xbc_h", ""},
      {"m_is_d", "M is the memory of D", alias('M', 'D'), "xgt_fenet/areas/words/xbc_h_m", ""},
      {"k_is_l", "K is the memory of L", alias('K', 'L'), "xgt_fenet/areas/words/xbc_h_k", ""},
      {"l_is_k", "L is the memory of K", alias('L', 'K'), "xgt_fenet/areas/words/xbc_h_l", ""},
      {"t_is_c", "T is the memory of C", alias('T', 'C'), "xgt_fenet/areas/words/xbc_h_t", ""},
      {"c_is_t", "C is the memory of T", alias('C', 'T'), "xgt_fenet/areas/words/xbc_h_c", ""},
      {"d_is_r", "D is the memory of R", alias('D', 'R'), "xgt_fenet/areas/words/xbc_h_d", ""},
      {"r_is_d", "R is the memory of D", alias('R', 'D'), "xgt_fenet/areas/words/xbc_h_r", ""},
      {"n_is_l", "N is the memory of L", alias('N', 'L'), "xgt_fenet/areas/words/xbc_h_n", ""},
      {"u_is_m", "U is the memory of M", alias('U', 'M'), "xgt_fenet/areas/words/xbc_h_u", ""},
      {"f_is_k", "F is the memory of K, and so writable", alias('F', 'K'),
       "xgt_fenet/areas/read_only/xbc_h_f_word", ""},
  };
}

}  // namespace fieldproof::xgt_fenet_broken
