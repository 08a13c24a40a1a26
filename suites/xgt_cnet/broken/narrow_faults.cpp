// Faults that show in one digit of a check, one bit of an address, or one use among several.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <deque>
#include <map>

#include "suites/xgt_cnet/broken/faults.hpp"

namespace fieldproof::xgt_cnet_broken {

namespace {

/// A request whose BCC is right in this digit is taken for right.
MakeBehaviour compares_one_digit(std::size_t digit) {
  return misread([digit](const Bytes& request, GoodPlc&) {
    FrameText text = take_apart(request);
    const std::string right = sum_of(text.without_check());
    if (text.check.size() != 2 || text.check[digit] != right[digit]) return request;
    text.check = right;
    return text.bytes();
  });
}

/// Addresses of words of the area never have this bit.
MakeBehaviour loses_address_bit(char area, int bit) {
  const std::string words = fmt::format("%{}W", area);
  return misread([=](const Bytes& request, GoodPlc&) {
    return with_names(request, [&](const std::string& name) {
      const NameParts parts = split_name(name);
      if (!parts.number || parts.area_and_type != words) return name;
      return fmt::format("{}{}", words, *parts.number & ~(1U << bit));
    });
  });
}

/// A registration is used up by so many executions.
MakeBehaviour serves(unsigned times) {
  return [times](Storage&) {
    Behaviour behaviour;
    behaviour.answer = [times, used = std::map<std::string, unsigned>()](const Bytes& request, bool,
                                                                         GoodPlc& plc) mutable {
      const FrameText text = take_apart(request);
      const std::string number = text.body.size() < 5 ? "" : text.body.substr(3, 2);
      Bytes reply = plc.answer(request);
      if (text.command() == 'x') used[number] = 0;
      if (text.command() == 'y' && ++used[number] > times)
        reply = nak_to(xgt_cnet::parse_request(request), xgt_cnet::xgt_error::not_registered);
      return broken::Sendings{{reply}};
    };
    return behaviour;
  };
}

/// Requests whose station has a letter in lower case are not heard.
Bytes deaf_to_small_stations(const Bytes& request, GoodPlc& plc) {
  const std::string station = take_apart(request).body.substr(0, 2);
  const bool small = std::ranges::any_of(station, [](char c) { return c >= 'a' && c <= 'f'; });
  return small ? Bytes{} : plc.answer(request);
}

/// One fault a bit of each area of an XBC: its last word has no more (Cnet EN 7.1.4).
std::vector<Fault> address_bits() {
  struct Area {
    char letter, small;
    unsigned last;
  };
  constexpr std::array areas{Area{'P', 'p', 1023}, Area{'M', 'm', 1023}, Area{'K', 'k', 4095},
                             Area{'F', 'f', 1023}, Area{'T', 't', 1023}, Area{'C', 'c', 1023},
                             Area{'L', 'l', 2047}, Area{'N', 'n', 5119}, Area{'D', 'd', 10239},
                             Area{'R', 'r', 10239}};
  static std::deque<std::string> texts;
  const auto text = [](std::string one) -> std::string_view {
    return texts.emplace_back(std::move(one));
  };
  std::vector<Fault> result;
  for (const Area& area : areas) {
    const int bits = std::bit_width(area.last);
    for (int bit = 0; bit < bits; ++bit)
      result.push_back(
          {text(fmt::format("{}_without_address_bit_{}", area.small, bit)),
           text(fmt::format("word {} of {} is taken for word 0", 1U << bit, area.letter)),
           loses_address_bit(area.letter, bit),
           text(fmt::format("areas/address_bits_{}/{}", bits, area.small)), "data",
           broken::in_process});
  }
  return result;
}

}  // namespace

std::vector<Fault> narrow_faults() {
  std::vector<Fault> result{
      {"bcc_first_digit_alone", "of the BCC of requests the first digit alone is compared",
       compares_one_digit(0), "frame_structure/other_sums_are_wrong/one_more", "silence",
       broken::in_process},
      {"bcc_second_digit_alone", "of the BCC of requests the second digit alone is compared",
       compares_one_digit(1), "frame_structure/other_sums_are_wrong/first_digit", "silence",
       broken::in_process},
      {"answers_station_00", "station 00 is taken for all stations",
       answer_with([](const Bytes& request, GoodPlc& plc) {
         FrameText text = take_apart(request);
         if (text.body.substr(0, 2) != "00") return plc.answer(request);
         text.body.replace(0, 2, hex_number(plc.station(), 2));
         text.seal();
         return plc.answer(text.bytes());
       }),
       "frame_structure/foreign_station_ff_and_00/00", "silence", broken::in_process},
      {"small_station_not_heard", "a station with lower-case digits is not answered",
       answer_with(deaf_to_small_stations), "frame_structure/station_in_lower_case_digits",
       "answer", broken::in_process}};
  for (const unsigned times : {2U, 3U, 4U})
    result.push_back({times == 2   ? "registration_serves_twice"
                      : times == 3 ? "registration_serves_three_times"
                                   : "registration_serves_four_times",
                      "a registration is used up by so many executions", serves(times),
                      "monitor_execute/executed_again/lower", "header", broken::in_process});
  std::ranges::move(address_bits(), std::back_inserter(result));
  return result;
}

}  // namespace fieldproof::xgt_cnet_broken
