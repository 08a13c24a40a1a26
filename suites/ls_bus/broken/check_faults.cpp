// Faults of the sum (Cnet EN 8.2: 'except ENQ and EOT') and of the station number.
#include <fmt/format.h>
#include <algorithm>
#include <cctype>

#include "suites/ls_bus/broken/faults.hpp"

namespace fieldproof::ls_bus_broken {

namespace {

constexpr std::string_view own_sum = "SUM";

/// Gives every reply another sum.
MakeBehaviour another_sum(std::string (*sum)(const FrameText& reply)) {
  return spoil_frame([sum](FrameText& reply, const FrameText&) { reply.sum = sum(reply); });
}

std::string exclusive_or(const FrameText& reply) {
  unsigned value = 0;
  for (const char c : reply.body) value ^= static_cast<unsigned char>(c);
  return hex_number(value, 2);
}

std::string complement(const FrameText& reply) {
  unsigned sum = 0;
  for (const char c : reply.body) sum += static_cast<unsigned char>(c);
  return hex_number((0x100 - (sum & 0xFF)) & 0xFF, 2);
}

void take_sum_of_all(FrameText& request) {
  if (request.sum == sum_of(request.head + request.body + request.tail)) request.seal();
}

/// Answers as the station that was asked for, where `takes` says so; with its own number if
/// `as_own`.
MakeBehaviour answers_for(bool (*takes)(std::string_view asked, unsigned own), bool as_own) {
  return [=] {
    Behaviour behaviour;
    behaviour.answer = [=](const Bytes& frame, bool, GoodInverter& inverter) {
      FrameText request = take_apart(frame);
      const std::string asked = request.body.substr(0, 2);
      if (!request.is_sealed() || asked.size() < 2 || !takes(asked, inverter.station()))
        return broken::Sendings{{inverter.answer(frame)}};
      request.body.replace(0, 2, hex_number(inverter.station(), 2));
      request.seal();
      FrameText reply = take_apart(inverter.answer(request.bytes()));
      if (!as_own) reply.body.replace(0, 2, asked);
      reply.seal();
      return broken::Sendings{{reply.bytes()}};
    };
    return behaviour;
  };
}

bool is_decimal(std::string_view asked, unsigned own) { return asked == fmt::format("{:02}", own); }

/// Looks at the sum before the station.
Behaviour refuses_for_others() {
  Behaviour behaviour;
  behaviour.answer = [](const Bytes& frame, bool, GoodInverter& inverter) {
    const FrameText request = take_apart(frame);
    if (request.body.size() < 3 || request.is_sealed())
      return broken::Sendings{{inverter.answer(frame)}};
    return broken::Sendings{{nak_to(request, "FE").bytes()}};
  };
  return behaviour;
}

}  // namespace

std::vector<Fault> check_faults() {
  return {
      {"sum_off_by_one", "the sum of replies is one too high",
       another_sum([](const FrameText& r) { return sum_of(r.body + '\x01'); }), "read/example",
       own_sum},
      {"sum_with_header", "the sum of replies takes ACK or NAK in",
       another_sum([](const FrameText& r) { return sum_of(r.head + r.body); }), "read/example",
       own_sum},
      {"sum_with_header_and_tail",
       "the sum of replies takes header and EOT in, as in the XGT protocol",
       another_sum([](const FrameText& r) { return sum_of(r.head + r.body + r.tail); }),
       "read/example", own_sum},
      {"sum_without_station", "the sum of replies leaves the station out",
       another_sum([](const FrameText& r) { return sum_of(r.body.substr(2)); }), "read/example",
       own_sum},
      {"sum_exclusive_or", "the sum of replies is the exclusive or", another_sum(exclusive_or),
       "read/example", own_sum},
      {"sum_complement", "the sum of replies is its two's complement", another_sum(complement),
       "read/example", own_sum},
      {"sum_digits_swapped", "the sum of replies has its low digit first",
       another_sum([](const FrameText& r) { return std::string(r.sum.rbegin(), r.sum.rend()); }),
       "read/example", own_sum},
      {"sum_in_lower_case", "the sum of replies has lower-case digits",
       another_sum([](const FrameText& r) { return in_lower_case(r.sum); }), "read/example",
       own_sum},
      {"no_sum", "replies have no sum", another_sum([](const FrameText&) { return std::string(); }),
       "read/example", own_sum},
      {"nak_without_sum", "a refusal has no sum", spoil_frame([](FrameText& r, const FrameText&) {
         if (r.is_nak()) r.sum.clear();
       }),
       "errors/format_of_the_nak_r", own_sum},
      {"ignores_sum", "the sum of requests is not looked at",
       misread([](FrameText& r) { r.seal(); }), "errors/wrong_sum/r", "header"},
      {"takes_the_sum_of_xgt", "a sum with header and EOT is taken too", misread(take_sum_of_all),
       "errors/other_sums/with_both", "header"},
      {"silent_on_wrong_sum", "a wrong sum is not refused",
       spoil_frame([](FrameText& r, const FrameText& request) {
         if (!request.is_sealed()) r.head = 0;
       }),
       "errors/wrong_sum/r", "no answer"},
      {"answers_foreign_stations",
       "requests to any station are answered, in the name of that station",
       answers_for([](std::string_view, unsigned) { return true; }, false),
       "stations/other_station_read", "silence"},
      {"answers_all_as_itself", "requests to any station are answered, with its own number",
       answers_for([](std::string_view, unsigned) { return true; }, true),
       "stations/other_station_read", "silence"},
      {"answers_station_ff", "station FF is taken for all stations",
       answers_for([](std::string_view asked, unsigned) { return asked == "FF"; }, true),
       "stations/foreign/ff", "silence"},
      {"answers_station_00", "station 00 is taken for all stations",
       answers_for([](std::string_view asked, unsigned) { return asked == "00"; }, true),
       "stations/foreign/00", "silence"},
      {"refuses_for_others", "a wrong sum in a request to another station is refused",
       refuses_for_others, "stations/other_station_wrong_sum", "silence"},
      {"station_in_decimal",
       "the station in replies is decimal",
       edit_reply([](FrameText& reply, const FrameText&) {
         const Bytes station = *from_hex(reply.body.substr(0, 2));
         reply.body.replace(0, 2, fmt::format("{:02}", station[0] % 100));
       }),
       "read/format_of_the_request",
       "station",
       {},
       16},
      {"takes_decimal_station",
       "its station in decimal digits is taken for its own",
       answers_for(is_decimal, true),
       "stations/not_decimal_16",
       "silence",
       {},
       16},
      {"station_zero_in_nak", "a refusal comes from station 00",
       edit_reply([](FrameText& reply, const FrameText&) {
         if (reply.is_nak()) reply.body.replace(0, 2, "00");
       }),
       "errors/format_of_the_nak_r", "station"},
  };
}

}  // namespace fieldproof::ls_bus_broken
