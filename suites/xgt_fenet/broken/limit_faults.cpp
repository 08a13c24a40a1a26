// Faults of limits: blocks, bytes, names, ends of areas, lengths (FEnet EN 5.1.2, table 5-4;
// DECISIONS.md fenet/limits, fenet/names).
#include <algorithm>

#include "suites/xgt_fenet/broken/faults.hpp"

namespace fieldproof::xgt_fenet_broken {

namespace {

/// The server refuses a request for which `of` holds with that code.
MakeBehaviour refuses(bool (*of)(const Bytes& request), unsigned code) {
  return edits([=](Bytes& reply, const Bytes& request) {
    if (of(request)) reply = refusal_of(request, code);
  });
}
/// The server answers as to another request.
MakeBehaviour takes(std::function<void(Bytes& request)> change) {
  return misreads([change](Bytes request) {
    change(request);
    return request;
  });
}
void set_length(Bytes& request) {
  put_word(request, length_at, static_cast<unsigned>(request.size() - body_at));
}

std::string name_text(const Bytes& request, const Name& name) {
  return {request.begin() + static_cast<std::ptrdiff_t>(name.at),
          request.begin() + static_cast<std::ptrdiff_t>(name.at + name.size)};
}
bool any_name(const Bytes& request, bool (*of)(const std::string& name)) {
  return std::ranges::any_of(names_of(request),
                             [&](const Name& name) { return of(name_text(request, name)); });
}
/// Puts another name in the place of the first.
void rename(Bytes& request, const std::string& other) {
  const Name name = names_of(request).at(0);
  const auto begin = request.begin() + static_cast<std::ptrdiff_t>(name.at);
  request.erase(begin, begin + static_cast<std::ptrdiff_t>(name.size));
  const Bytes text = to_bytes(other);
  request.insert(request.begin() + static_cast<std::ptrdiff_t>(name.at), text.begin(), text.end());
  put_word(request, name.at - 2, static_cast<unsigned>(text.size()));
  set_length(request);
}
/// The count of a continuous read.
unsigned run_of(const Bytes& request) {
  const bool run = is_continuous(request) && is_read(request) && request.size() > name_at + 2;
  return run ? word_at(request, request.size() - 2) : 0;
}

}  // namespace

std::vector<Fault> limit_faults() {
  return {
      {"fifteen_blocks", "16 blocks are one too many",
       refuses(
           [](const Bytes& r) { return word_at(r, count_at) == 16 && names_of(r).size() == 16; },
           0x01),
       "xgt_fenet/read/block_counts/n16", ""},
      {"fifteen_written", "16 blocks are one too many to write",
       refuses([](const Bytes& r) { return is_write(r) && word_at(r, count_at) == 16; }, 0x01),
       "xgt_fenet/write/block_counts/n16", ""},
      {"four_blocks", "more than 4 blocks are refused",
       refuses([](const Bytes& r) { return is_read(r) && names_of(r).size() > 4; }, 0x01),
       "xgt_fenet/read/block_counts/n5", ""},
      {"seventeen_blocks", "of 17 blocks the first 16 are served", takes([](Bytes& request) {
         const std::vector<Name> names = names_of(request);
         if (!is_read(request) || names.size() != 17) return;
         request.resize(names.back().at - 2);
         put_word(request, count_at, 16);
         set_length(request);
       }),
       "xgt_fenet/read/seventeen_blocks/word", ""},
      {"no_blocks_answered", "a request of no blocks is answered with none",
       edits([](Bytes& reply, const Bytes& request) {
         if (word_at(request, count_at) != 0 || !is_refusal(reply)) return;
         put_word(reply, status_at, 0);
         put_word(reply, reply_blocks_at, 0);
       }),
       "xgt_fenet/read/no_blocks", ""},
      {"run_of_511", "512 bytes are one too many for a read",
       refuses([](const Bytes& r) { return run_of(r) == 512; }, 0x05),
       "xgt_fenet/continuous/read_long/n512", ""},
      {"run_of_256", "more than 256 bytes are refused, as table 5-4 has it",
       refuses([](const Bytes& r) { return run_of(r) > 256; }, 0x05),
       "xgt_fenet/continuous/read_long/n257", ""},
      {"run_of_513", "of 513 bytes 512 are read", takes([](Bytes& request) {
         if (run_of(request) == 513) put_word(request, request.size() - 2, 512);
       }),
       "xgt_fenet/continuous/read_too_much/n513", ""},
      {"run_of_one_byte", "the high byte of a continuous count is lost", takes([](Bytes& request) {
         if (const unsigned run = run_of(request); run > 0xFF)
           put_word(request, request.size() - 2, run & 0xFF);
       }),
       "xgt_fenet/continuous/read_long/n257", ""},
      {"run_swapped", "a continuous count is read high byte first", takes([](Bytes& request) {
         if (const unsigned run = run_of(request); run != 0)
           put_word(request, request.size() - 2, (run & 0xFF) << 8 | run >> 8);
       }),
       "xgt_fenet/continuous/read_counts/n2", ""},
      {"run_of_words", "a continuous count is one of words", takes([](Bytes& request) {
         if (const unsigned run = run_of(request); run != 0 && run < 128)
           put_word(request, request.size() - 2, 2 * run);
       }),
       "xgt_fenet/continuous/read_counts/n2", ""},
      {"run_even", "an odd number of bytes is refused",
       refuses([](const Bytes& r) { return run_of(r) % 2 == 1; }, 0x05),
       "xgt_fenet/continuous/read_counts/n3", ""},
      {"run_of_0_taken", "a continuous read of no byte reads one", takes([](Bytes& request) {
         if (is_read(request) && is_continuous(request) && request.size() > name_at + 2 &&
             word_at(request, request.size() - 2) == 0)
           put_word(request, request.size() - 2, 1);
       }),
       "xgt_fenet/continuous/count_0/read", ""},
      {"written_511", "512 bytes are one too many for a write",
       refuses([](const Bytes& r) { return is_write(r) && is_continuous(r) && r.size() > 512; },
               0x05),
       "xgt_fenet/continuous/write_long/n512", ""},
      {"two_runs_taken", "of two continuous blocks the first is read", takes([](Bytes& request) {
         if (is_continuous(request) && is_read(request) && word_at(request, count_at) == 2)
           put_word(request, count_at, 1),
               request.resize(names_of(request)[0].at + names_of(request)[0].size),
               request.insert(request.end(), {1, 0}), set_length(request);
       }),
       "xgt_fenet/continuous/block_counts/read_2", ""},
      {"words_in_a_run", "a continuous read takes a name of words", takes([](Bytes& request) {
         if (is_continuous(request) && !names_of(request).empty() && request.size() > name_at + 2)
           if (Byte& letter = request[names_of(request)[0].at + 2]; letter == 'W') letter = 'B';
       }),
       "xgt_fenet/continuous/other_types/read_w", ""},
      {"name_of_15", "a name of 16 characters is too long",
       refuses(
           [](const Bytes& r) {
             return any_name(r, [](const std::string& name) { return name.size() == 16; });
           },
           0x11),
       "xgt_fenet/names/lengths/l16", ""},
      {"name_of_17", "a name of 17 characters is taken", takes([](Bytes& request) {
         const std::vector<Name> names = names_of(request);
         if (names.size() != 1 || names[0].size != 17) return;
         const std::string name = name_text(request, names[0]);
         rename(request, name.substr(0, 3) + name.substr(4));
       }),
       "xgt_fenet/names/wrong_lengths/l17", ""},
      {"name_of_5", "a name of 4 characters is too short",
       refuses(
           [](const Bytes& r) {
             return any_name(r, [](const std::string& name) { return name.size() == 4; });
           },
           0x11),
       "xgt_fenet/names/shortest", ""},
      {"no_leading_zeros", "a number that begins with 0 is refused",
       refuses(
           [](const Bytes& r) {
             return any_name(r, [](const std::string& n) { return n.size() > 5 && n[3] == '0'; });
           },
           0x11),
       "xgt_fenet/names/lengths/l9", ""},
      {"no_lower_case", "a name in lower case is refused",
       refuses(
           [](const Bytes& r) {
             return any_name(r, [](const std::string& n) {
               return std::ranges::any_of(n, [](char c) { return c >= 'a' && c <= 'z'; });
             });
           },
           0x11),
       "xgt_fenet/names/lower_case/all", ""},
      {"percent_not_needed", "a name may begin with $", takes([](Bytes& request) {
         for (const Name& name : names_of(request))
           if (name.size > 0 && request[name.at] == '$') request[name.at] = '%';
       }),
       "xgt_fenet/names/without_percent/dollar", ""},
      {"letter_not_looked_at", "the type letter of a word's name is not looked at",
       takes([](Bytes& request) {
         if (word_at(request, type_at) == 2)
           for (const Name& name : names_of(request))
             if (name.size > 2) request[name.at + 2] = 'W';
       }),
       "xgt_fenet/names/type_against_letter/word_by_b", ""},
      {"letter_of_the_first", "the type letter of the first name alone is looked at",
       takes([](Bytes& request) {
         const std::vector<Name> names = names_of(request);
         for (std::size_t i = 1; i < names.size(); ++i)
           if (names[i].size > 2) request[names[i].at + 2] = request[names[0].at + 2];
       }),
       "xgt_fenet/names/letter_of_the_second/second", ""},
      {"surplus_of_a_number", "what stands behind the digits of a name is not looked at",
       takes([](Bytes& request) {
         const std::vector<Name> names = names_of(request);
         if (names.size() != 1 || names[0].size < 5) return;
         std::string name = name_text(request, names[0]);
         if (name.back() == ' ' || name.back() == '\0') name.pop_back(), rename(request, name);
       }),
       "xgt_fenet/names/not_a_number/space_behind", ""},
      {"sizes_not_looked_at", "the size of what is written is not looked at",
       takes([](Bytes& request) {
         if (!is_write(request) || is_continuous(request)) return;
         const std::vector<Name> data = data_of(request);
         if (data.size() != 1 || word_at(request, type_at) != 2 || data[0].size != 1) return;
         put_word(request, data[0].at - 2, 2);
         request.push_back(0);
         set_length(request);
       }),
       "xgt_fenet/write/size_of_another_type/word_1", ""},
      {"cut_body_answered", "a write that is cut in its last word writes a byte",
       takes([](Bytes& request) {
         if (!is_write(request) || is_continuous(request)) return;
         const std::vector<Name> names = names_of(request);
         if (names.size() != 1) return;
         const std::size_t end = names[0].at + names[0].size;
         if (request.size() != end + 3 || word_at(request, end) != 2) return;
         request.push_back(0);
         set_length(request);
       }),
       "xgt_fenet/length/cut_write/at_19", ""},
      {"missing_block_zero", "a name that is announced and does not come is left out",
       takes([](Bytes& request) {
         const std::size_t names = names_of(request).size();
         if (is_read(request) && !is_continuous(request) && names + 1 == word_at(request, count_at))
           put_word(request, count_at, static_cast<unsigned>(names));
       }),
       "xgt_fenet/length/block_missing/two", ""},
      {"end_not_looked_at", "past the end of M the server reads M0", takes([](Bytes& request) {
         if (names_of(request).size() == 1 && name_text(request, names_of(request)[0]) == "%MW1024")
           rename(request, "%MW0000");
       }),
       "xgt_fenet/areas/words/xbc_h_m", ""},
      {"end_one_early", "the last word of M is past its end",
       refuses(
           [](const Bytes& r) {
             return any_name(r, [](const std::string& name) { return name == "%MW1023"; });
           },
           0x04),
       "xgt_fenet/areas/words/xbc_h_m", ""},
      {"end_of_lwords_early", "the last long word of M is past its end",
       refuses(
           [](const Bytes& r) {
             return any_name(r, [](const std::string& name) { return name == "%ML255"; });
           },
           0x04),
       "xgt_fenet/areas/lwords/xbc_h_m", ""},
      {"stop_refuses", "in STOP nothing is read",
       [] {
         return Behaviour{.act = [](Bursts& does, Server&) {
           for (Burst& one : does)
             if (word_at(one.bytes, plc_info_at) == 0x0207 && !is_refusal(one.bytes))
               one.bytes = refusal_of(one.bytes, 0x78);
         }};
       },
       "xgt_fenet/read/in_stop", ""},
  };
}

}  // namespace fieldproof::xgt_fenet_broken
