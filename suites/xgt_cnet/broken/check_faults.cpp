// Faults of the BCC (Cnet EN 7.1.3) and of the station number.
#include <algorithm>
#include <cctype>

#include "suites/xgt_cnet/broken/faults.hpp"

namespace fieldproof::xgt_cnet_broken {

namespace {

constexpr std::string_view own_sum = "BCC";

/// Gives every reply that has a BCC another one.
MakeBehaviour another_check(std::string (*check)(const FrameText& reply)) {
  return spoil_frame([check](FrameText& reply, const FrameText&) {
    if (!reply.check.empty()) reply.check = check(reply);
  });
}

std::string in_lower_case(std::string text) {
  std::ranges::transform(text, text.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

std::string exclusive_or(const FrameText& reply) {
  unsigned value = 0;
  for (const char c : reply.without_check()) value ^= static_cast<unsigned char>(c);
  return hex_number(value, 2);
}

/// Takes every request as its own: puts its own station in, and a right BCC.
Bytes addressed_to(unsigned station, const Bytes& request) {
  FrameText text = take_apart(request);
  text.body.replace(0, 2, hex_number(station, 2));
  text.seal();
  return text.bytes();
}

bool right_check(const Bytes& request) {
  const FrameText text = take_apart(request);
  return text.check.empty() ||
         in_lower_case(text.check) == in_lower_case(sum_of(text.without_check()));
}

/// Answers as the station that was asked for, where `takes` says so.
MakeBehaviour answers_for(bool (*takes)(std::string_view station), bool as_own) {
  return answer_with([takes, as_own](const Bytes& request, GoodPlc& plc) {
    const std::string station = take_apart(request).body.substr(0, 2);
    if (!takes(station) || !right_check(request)) return plc.answer(request);
    FrameText reply = take_apart(plc.answer(addressed_to(plc.station(), request)));
    if (reply.body.empty()) return Bytes{};
    if (!as_own) reply.body.replace(0, 2, station);
    reply.seal();
    return reply.bytes();
  });
}

Bytes answer_without_check(const Bytes& heard, GoodPlc& plc) {
  if (heard.empty() || heard.back() != xgt_cnet::xgt_eot) return {};
  return plc.answer(to_bytes(to_text(heard) + sum_of(to_text(heard))));
}

Behaviour no_need_of_check(Storage&) {
  Behaviour behaviour;
  behaviour.cut_off = [](const Bytes& heard, GoodPlc& plc) {
    return broken::Sendings{{answer_without_check(heard, plc)}};
  };
  return behaviour;
}

}  // namespace

std::vector<Fault> check_faults() {
  const auto any = [](std::string_view) { return true; };
  const auto all_stations = [](std::string_view station) { return station == "FF"; };
  return {
      {"bcc_off_by_one", "the BCC of replies is one too high",
       another_check([](const FrameText& r) { return sum_of(r.without_check() + '\x01'); }),
       "rss/two_words/lower", own_sum},
      {"bcc_without_tail",
       "the BCC of replies leaves ETX out",
       another_check([](const FrameText& r) { return sum_of(r.head + r.body); }),
       "rss/bcc_of_the_reply/0b6c",
       own_sum,
       {},
       32},
      {"bcc_without_header",
       "the BCC of replies leaves ACK or NAK out",
       another_check([](const FrameText& r) { return sum_of(r.body + r.tail); }),
       "rss/refused/lower",
       own_sum,
       {},
       32},
      {"bcc_of_body", "the BCC of replies is the sum between header and tail",
       another_check([](const FrameText& r) { return sum_of(r.body); }), "rsb/two_words/lower",
       own_sum},
      {"bcc_exclusive_or", "the BCC of replies is the exclusive or", another_check(exclusive_or),
       "rss/two_words/lower", own_sum},
      {"bcc_digits_swapped", "the BCC of replies has its low digit first",
       another_check(
           [](const FrameText& r) { return std::string(r.check.rbegin(), r.check.rend()); }),
       "rss/two_words/lower", own_sum},
      {"bcc_in_lower_case", "the BCC of replies has lower-case digits",
       another_check([](const FrameText& r) { return in_lower_case(r.check); }),
       "rss/two_words/lower", own_sum},
      {"bcc_on_upper_case", "replies to upper-case commands have a BCC too",
       spoil_frame([](FrameText& r, const FrameText&) { r.check = sum_of(r.without_check()); }),
       "frame_structure/control_codes_ack/upper", "after the complete exchange"},
      {"no_bcc_on_lower_case", "replies to lower-case commands have no BCC",
       spoil_frame([](FrameText& r, const FrameText&) { r.check.clear(); }),
       "frame_structure/control_codes_ack/lower", own_sum},
      {"nak_without_bcc", "a NAK has no BCC", spoil_frame([](FrameText& r, const FrameText&) {
         if (r.is_nak()) r.check.clear();
       }),
       "frame_structure/nak/lower", own_sum},
      {"ignores_bcc", "the BCC of requests is not looked at",
       misread([](const Bytes& request, GoodPlc&) {
         FrameText text = take_apart(request);
         text.seal();
         return text.bytes();
       }),
       "frame_structure/wrong_bcc_is_silent/ss", "silence"},
      {"needs_no_bcc", "a lower-case request without BCC is answered all the same",
       no_need_of_check, "frame_structure/lower_case_without_bcc", "silence"},
      {"upper_case_needs_bcc", "an upper-case request without BCC is not answered",
       answer_with([](const Bytes& request, GoodPlc& plc) {
         const bool lower = take_apart(request).lower_case();
         return lower ? plc.answer(request) : Bytes{};
       }),
       "frame_structure/upper_case_nak_has_no_bcc/ss", "no answer"},
      {"answers_foreign_stations",
       "requests to any station are answered, in the name of that station", answers_for(any, false),
       "frame_structure/foreign_station_is_silent/lower", "silence"},
      {"answers_all_as_itself", "requests to any station are answered, with its own number",
       answers_for(any, true), "frame_structure/foreign_station_is_silent/lower", "silence"},
      {"answers_station_ff", "station FF is taken for all stations",
       answers_for(all_stations, false), "frame_structure/foreign_station_ff_and_00/ff", "silence"},
      {"station_in_decimal",
       "the station in replies is decimal",
       edit_reply([](FrameText& reply, const FrameText&) {
         const auto station = static_cast<unsigned>(xgt_cnet::hex_value(reply.body.substr(0, 2)));
         reply.body.replace(
             0, 2,
             {static_cast<char>('0' + station / 10 % 10), static_cast<char>('0' + station % 10)});
       }),
       "rss/read_one_word/lower",
       "station",
       {},
       32},
      {"station_zero_in_nak", "a NAK comes from station 00",
       edit_reply([](FrameText& reply, const FrameText&) {
         if (reply.is_nak()) reply.body.replace(0, 2, "00");
       }),
       "frame_structure/nak/lower", "station"},
  };
}

}  // namespace fieldproof::xgt_cnet_broken
