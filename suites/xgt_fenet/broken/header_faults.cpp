// Faults of the header of a reply (FEnet EN 5.2.3, table 5-3).
#include <algorithm>
#include <numeric>

#include "suites/xgt_fenet/broken/faults.hpp"

namespace fieldproof::xgt_fenet_broken {

namespace {

bool always(const Bytes&, const Bytes&) { return true; }
bool of_write(const Bytes&, const Bytes& request) { return is_write(request); }
bool of_run(const Bytes&, const Bytes& request) { return is_continuous(request); }
bool refused(const Bytes& reply, const Bytes&) { return is_refusal(reply); }

/// A word of the header is another one.
MakeBehaviour word_is(std::size_t at, unsigned (*change)(unsigned)) {
  return edits_if(always, [=](Bytes& reply) { put_word(reply, at, change(word_at(reply, at))); });
}
MakeBehaviour byte_is(std::size_t at, Byte (*change)(Byte)) {
  return edits_if(always, [=](Bytes& reply) { reply[at] = change(reply[at]); });
}

/// Numbers its replies itself.
Behaviour counting() {
  return {.edit = [next = 0u](Bytes& reply, const Bytes&) mutable {
    put_word(reply, invoke_at, ++next);
    mend(reply);
  }};
}
Behaviour first_invoke() {
  return {.edit = [first = -1](Bytes& reply, const Bytes& request) mutable {
    if (first < 0) first = static_cast<int>(word_at(request, invoke_at));
    put_word(reply, invoke_at, static_cast<unsigned>(first));
    mend(reply);
  }};
}
Behaviour deaf_to_repeated_invoke() {
  return {.misread = [last = -1](Bytes request) mutable {
    const int now = static_cast<int>(word_at(request, invoke_at));
    const bool again = now == last;
    last = now;
    return again ? Bytes{} : request;
  }};
}

/// The check is that of something else.
MakeBehaviour check_is(Byte (*check)(const Bytes& reply)) {
  return edits([=](Bytes& reply, const Bytes&) { reply[check_at] = check(reply); });
}
Byte sum_from(const Bytes& bytes, std::size_t from, std::size_t to) {
  return static_cast<Byte>(std::accumulate(bytes.begin() + static_cast<std::ptrdiff_t>(from),
                                           bytes.begin() + static_cast<std::ptrdiff_t>(to), 0u));
}

}  // namespace

std::vector<Fault> header_faults() {
  const auto zero = [](unsigned) { return 0u; };
  return {
      {"company_always_xgt", "replies have LSIS-XGT, whatever asks",
       edits_if(always,
                [](Bytes& reply) {
                  const Bytes id = to_bytes(std::string("LSIS-XGT\0\0", 10));
                  std::ranges::copy(id, reply.begin());
                }),
       "xgt_fenet/header/company_id/id_2", "company id"},
      {"company_ends_in_line_feeds", "the id of replies ends as table 5-5 spells it: two \\n",
       edits_if(always, [](Bytes& reply) { reply[8] = reply[9] = '\n'; }),
       "xgt_fenet/header/company_id/id_1", "company id"},
      {"source_of_client", "replies have the source of a client",
       byte_is(source_at, [](Byte) { return Byte{0x33}; }), "xgt_fenet/header/source_of_reply/read",
       "source"},
      {"source_of_run_of_client", "replies to continuous requests have the source of a client",
       edits_if(of_run, [](Bytes& reply) { reply[source_at] = 0x33; }),
       "xgt_fenet/header/source_of_reply/continuous_read", "source"},
      {"source_of_write_zero", "replies to writes have source 00",
       edits_if(of_write, [](Bytes& reply) { reply[source_at] = 0; }),
       "xgt_fenet/header/source_of_reply/write", "source"},
      {"cpu_of_xgk", "CPU info is that of an XGK, as the examples print it",
       byte_is(cpu_at, [](Byte) { return Byte{0xA0}; }), "xgt_fenet/header/cpu_info_of_reply/xbc_h",
       "CPU info"},
      {"cpu_of_iec", "CPU info is that of an IEC model",
       byte_is(cpu_at, [](Byte) { return Byte{0xB4}; }), "xgt_fenet/header/cpu_info_of_reply/xbc_h",
       "CPU info"},
      {"plc_info_zero", "PLC info is zero, as in requests", word_is(plc_info_at, zero),
       "xgt_fenet/header/plc_info_run/read", "PLC info"},
      {"plc_info_swapped", "the bytes of the PLC info change places", word_is(plc_info_at, swapped),
       "xgt_fenet/header/plc_info_run/read", "PLC info"},
      {"plc_info_always_run", "PLC info says RUN in STOP, too",
       word_is(plc_info_at, [](unsigned info) { return (info & 0xE0FFu) | 0x0100u; }),
       "xgt_fenet/header/plc_info_stop/read", "PLC info"},
      {"plc_info_without_error_bit", "bit 7 of the PLC info does not tell a CPU error",
       word_is(plc_info_at, [](unsigned info) { return info & ~0x80u; }),
       "xgt_fenet/header/plc_info_error/read", "PLC info"},
      {"plc_info_without_error_state", "the state of the PLC info stays RUN with a CPU error",
       word_is(plc_info_at, [](unsigned info) { return (info & 0xE0FFu) | 0x0100u; }),
       "xgt_fenet/header/plc_info_error/write", "PLC info"},
      {"plc_info_of_refusal_zero", "refusals have no PLC info",
       edits_if(refused, [](Bytes& reply) { put_word(reply, plc_info_at, 0); }),
       "xgt_fenet/header/plc_info_run/refusal", "PLC info"},
      {"invoke_zero", "replies have invoke id 0", word_is(invoke_at, zero),
       "xgt_fenet/header/invoke/i1234", "invoke id"},
      {"invoke_swapped", "the bytes of the invoke id change places", word_is(invoke_at, swapped),
       "xgt_fenet/header/invoke/i1234", "invoke id"},
      {"invoke_of_one_byte", "the high byte of the invoke id is lost",
       word_is(invoke_at, [](unsigned id) { return id & 0xFFu; }), "xgt_fenet/header/invoke/i0100",
       "invoke id"},
      {"invoke_of_15_bits", "the top bit of the invoke id is lost",
       word_is(invoke_at, [](unsigned id) { return id & 0x7FFFu; }),
       "xgt_fenet/header/invoke/i8000", "invoke id"},
      {"invoke_one_more", "replies have the invoke id plus one",
       word_is(invoke_at, [](unsigned id) { return (id + 1) & 0xFFFFu; }),
       "xgt_fenet/header/invoke/i0000", "invoke id"},
      {"invoke_counted", "the server numbers its replies itself", counting,
       "xgt_fenet/header/invoke_any_order", "invoke id"},
      {"invoke_of_the_first", "all replies have the first invoke id", first_invoke,
       "xgt_fenet/header/invoke_any_order", "invoke id"},
      {"invoke_lost_in_writes", "replies to writes have invoke id 0",
       edits_if(of_write, [](Bytes& reply) { put_word(reply, invoke_at, 0); }),
       "xgt_fenet/header/invoke_of_a_write", "invoke id"},
      {"invoke_lost_in_refusals", "refusals have invoke id 0",
       edits_if(refused, [](Bytes& reply) { put_word(reply, invoke_at, 0); }),
       "xgt_fenet/header/invoke_of_a_refusal", "invoke id"},
      {"repeated_invoke_ignored", "an invoke id that was just used is no request",
       deaf_to_repeated_invoke, "xgt_fenet/header/invoke_again", "no answer"},
      {"length_one_more", "the length field of replies is one too many",
       word_is(length_at, [](unsigned n) { return n + 1; }), "xgt_fenet/length/of_reply/word", ""},
      {"length_one_less", "the length field of replies is one too few",
       word_is(length_at, [](unsigned n) { return n - 1; }), "xgt_fenet/length/of_reply/word", ""},
      {"length_with_header", "the length field of replies counts the header, too",
       word_is(length_at, [](unsigned n) { return n + 20; }), "xgt_fenet/length/of_reply/word", ""},
      {"length_swapped", "the bytes of the length field change places", word_is(length_at, swapped),
       "xgt_fenet/length/of_reply/two_words", ""},
      {"length_of_one_byte", "the high byte of the length field is lost",
       word_is(length_at, [](unsigned n) { return n & 0xFFu; }),
       "xgt_fenet/length/of_reply/continuous_244", ""},
      {"position_zero", "replies have position 00",
       byte_is(position_at, [](Byte) { return Byte{0}; }),
       "xgt_fenet/header/position_of_reply_b0_s2", "position"},
      {"position_without_base", "the base is not in the position",
       byte_is(position_at, [](Byte position) { return static_cast<Byte>(position & 0x0F); }),
       "xgt_fenet/header/position_of_reply_b1_s3", "position"},
      {"position_swapped", "slot and base of the position change places",
       byte_is(position_at,
               [](Byte position) { return static_cast<Byte>(position << 4 | position >> 4); }),
       "xgt_fenet/header/position_of_reply_b1_s3", "position"},
      {"position_of_refusal_zero", "refusals have position 00",
       edits_if(refused, [](Bytes& reply) { reply[position_at] = 0; }),
       "xgt_fenet/header/position_of_refusal", "position"},
      {"check_over_20_bytes", "the check covers itself, as sent by the client",
       check_is([](const Bytes& reply) { return static_cast<Byte>(sum_of_header(reply) * 2); }),
       "xgt_fenet/header/check_of_reply/read", "check sum"},
      {"check_over_the_body", "the check covers the body, too", check_is([](const Bytes& reply) {
         return static_cast<Byte>(sum_of_header(reply) + sum_from(reply, body_at, reply.size()));
       }),
       "xgt_fenet/header/check_of_reply/read", "check sum"},
      {"check_behind_the_id", "the check does not cover the company id",
       check_is([](const Bytes& reply) { return sum_from(reply, 10, check_at); }),
       "xgt_fenet/header/check_of_reply/read", "check sum"},
      {"check_zero", "replies have check 00", check_is([](const Bytes&) { return Byte{0}; }),
       "xgt_fenet/header/check_of_reply/read", "check sum"},
      {"check_complement", "the check is the complement of the sum",
       check_is([](const Bytes& reply) { return static_cast<Byte>(0x100 - sum_of_header(reply)); }),
       "xgt_fenet/header/check_of_reply/write", "check sum"},
      {"check_of_refusal_zero", "refusals have check 00", edits([](Bytes& reply, const Bytes&) {
         if (is_refusal(reply)) reply[check_at] = 0;
       }),
       "xgt_fenet/header/check_of_reply/refusal", "check sum"},
  };
}

}  // namespace fieldproof::xgt_fenet_broken
