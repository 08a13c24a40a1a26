// Faults of the checks, of the station number and of the form of frames (Cnet EN 9.3.1, 9.3.2).
#include <algorithm>
#include <cctype>

#include "src/base/bytes.hpp"
#include "src/modbus/checks.hpp"
#include "suites/modbus/broken/faults.hpp"

namespace fieldproof::modbus_broken {

namespace {

constexpr std::size_t check_size = 2;

/// Gives every RTU reply another CRC.
MakeBehaviour another_crc(std::uint16_t (*check)(ByteView message)) {
  return spoil_frame([check](Bytes& frame) {
    const std::uint16_t crc = check(ByteView(frame).first(frame.size() - check_size));
    frame[frame.size() - 2] = static_cast<Byte>(crc);
    frame[frame.size() - 1] = static_cast<Byte>(crc >> 8);
  });
}

std::uint16_t crc_from_zero(ByteView message) {
  std::uint16_t crc = 0;
  for (const Byte b : message) {
    crc ^= b;
    for (int i = 0; i < 8; ++i)
      crc = static_cast<std::uint16_t>((crc & 1) ? (crc >> 1) ^ 0xA001 : crc >> 1);
  }
  return crc;
}

/// Gives every ASCII reply another LRC: two characters before CR LF.
MakeBehaviour another_lrc(Byte (*check)(ByteView characters)) {
  return spoil_frame([check](Bytes& frame) {
    const std::size_t at = frame.size() - 4;
    const std::string digits = hex_number(check(ByteView(frame).first(at)), 2);
    std::copy(digits.begin(), digits.end(), frame.begin() + static_cast<std::ptrdiff_t>(at));
  });
}

unsigned sum_of_pairs(ByteView characters) {
  unsigned sum = 0;
  const std::optional<Bytes> bytes = from_hex(to_text(characters.subspan(1)));
  for (const Byte b : bytes.value_or(Bytes{})) sum += b;
  return sum;
}

Byte lrc_without_complement(ByteView characters) {
  return static_cast<Byte>(sum_of_pairs(characters));
}
Byte lrc_as_ones_complement(ByteView characters) {
  return static_cast<Byte>(~sum_of_pairs(characters));
}
/// The LRC of the characters that travel, not of the bytes that they stand for.
Byte lrc_of_characters(ByteView characters) { return modbus::modbus_lrc(characters.subspan(1)); }

void lower_case(Bytes& frame, std::size_t from, std::size_t to) {
  for (std::size_t i = from; i < to; ++i) frame[i] = static_cast<Byte>(std::tolower(frame[i]));
}

/// What a frame says, its check unseen; empty where it is too short.
Bytes without_check(const Bytes& frame, modbus::ModbusMode mode) {
  if (mode == modbus::ModbusMode::rtu)
    return frame.size() < 4 ? Bytes{} : Bytes(frame.begin(), frame.end() - check_size);
  if (frame.size() < 9) return {};
  Bytes bytes = from_hex(to_text(ByteView(frame).subspan(1, frame.size() - 3))).value_or(Bytes{});
  if (!bytes.empty()) bytes.pop_back();
  return bytes;
}

/// Answers with the characters of an ASCII request changed and a right LRC; as they are where they
/// are right.
Bytes forgive(const Bytes& frame, GoodModbus& plc, Bytes (*change)(Bytes frame)) {
  Bytes reply = plc.answer(frame);
  if (!reply.empty() || frame.size() < 9) return reply;
  const Bytes message = without_check(change(frame), plc.mode());
  return message.size() < 2 || message[0] != plc.station() ? Bytes{}
                                                           : plc.answer(plc.frame(message));
}

Bytes drop_odd_digit(Bytes frame) {
  if (frame.size() % 2 == 0) frame.erase(frame.end() - 3);
  return frame;
}

Bytes zero_for_not_hex(Bytes frame) {
  for (std::size_t i = 1; i + 2 < frame.size(); ++i)
    if (hex_digit(static_cast<char>(frame[i])) < 0) frame[i] = '0';
  return frame;
}

MakeBehaviour forgiving(Bytes (*change)(Bytes frame)) {
  return answer_frame(
      [change](const Bytes& frame, GoodModbus& plc) { return forgive(frame, plc, change); });
}

/// Answers requests to other stations, too.
MakeBehaviour answers_for(bool (*takes)(Byte station), bool as_own) {
  return answer_with([takes, as_own](const Bytes& request, GoodModbus& plc) {
    if (request[0] == plc.station() || !takes(request[0])) return plc.ask(request);
    Bytes reply = plc.ask_as_own(request);
    if (!reply.empty() && !as_own) reply[0] = request[0];
    return reply;
  });
}

}  // namespace

std::vector<Fault> frame_faults() {
  const auto any = [](Byte) { return true; };
  return {
      {"crc_high_byte_first", "the CRC of replies has its high byte first",
       spoil_frame(
           [](Bytes& frame) { std::swap(frame[frame.size() - 2], frame[frame.size() - 1]); }),
       "modbus_rtu/modes/serves", "CRC"},
      {"crc_from_zero", "the CRC of replies starts from 0000", another_crc(crc_from_zero),
       "modbus_rtu/modes/serves", "CRC"},
      {"crc_without_station", "the CRC of replies leaves the station out",
       another_crc([](ByteView message) { return modbus::modbus_crc(message.subspan(1)); }),
       "modbus_rtu/modes/serves", "CRC"},
      {"crc_missing_on_exceptions", "an exception has no CRC", spoil_frame([](Bytes& frame) {
         if (frame[1] & 0x80) frame.resize(frame.size() - check_size);
       }),
       "modbus_rtu/examples/read_coil_status_refused", "CRC"},
      {"crc_ignored", "the CRC of requests is not looked at",
       answer_frame([](const Bytes& frame, GoodModbus& plc) {
         const Bytes message = without_check(frame, plc.mode());
         return message.size() < 2 || message[0] != plc.station() ? Bytes{}
                                                                  : plc.answer(plc.frame(message));
       }),
       "modbus_rtu/line/wrong_check/f06", "silence"},
      {"lrc_ignored", "the LRC of requests is not looked at",
       forgiving([](Bytes frame) { return frame; }), "modbus_ascii/line/wrong_check/f06",
       "silence"},
      {"lrc_in_lower_case", "the LRC of replies has lower-case digits",
       spoil_frame([](Bytes& frame) { lower_case(frame, frame.size() - 4, frame.size()); }),
       "modbus_ascii/examples/read_holding_registers", "LRC"},
      {"lrc_without_complement", "the LRC of replies is the sum itself",
       another_lrc(lrc_without_complement), "modbus_ascii/modes/serves", "LRC"},
      {"lrc_ones_complement", "the LRC of replies is the one's complement",
       another_lrc(lrc_as_ones_complement), "modbus_ascii/modes/serves", "LRC"},
      {"lrc_of_characters", "the LRC of replies sums the characters",
       another_lrc(lrc_of_characters), "modbus_ascii/modes/serves", "LRC"},
      {"replies_in_lower_case", "replies have lower-case digits",
       spoil_frame([](Bytes& frame) { lower_case(frame, 0, frame.size() - 4); }),
       "modbus_ascii/line/replies_in_upper_case", "data"},
      {"lf_missing", "replies end with CR alone",
       spoil_frame([](Bytes& frame) { frame.pop_back(); }), "modbus_ascii/modes/serves", "tail"},
      {"cr_missing", "replies end with LF alone",
       spoil_frame([](Bytes& frame) { frame.erase(frame.end() - 2); }), "modbus_ascii/modes/serves",
       "tail"},
      {"colon_missing", "replies have no colon",
       spoil_frame([](Bytes& frame) { frame.erase(frame.begin()); }),
       "modbus_ascii/examples/read_coil_status_refused", "header"},
      {"odd_digits_answered", "the last of an odd number of digits is dropped",
       forgiving(drop_odd_digit), "modbus_ascii/line/odd_digits/one_more", "silence"},
      {"not_hex_is_zero", "a character that is not hex is taken for 0", forgiving(zero_for_not_hex),
       "modbus_ascii/line/not_hex/g", "silence"},
      {"answers_foreign_stations", "requests to any station are answered, in its name",
       answers_for(any, false), "modbus_rtu/station/other_numbers/s02", "silence"},
      {"answers_all_as_itself", "requests to any station are answered, with the own number",
       answers_for(any, true), "modbus_ascii/station/other_numbers/s02", "silence"},
      {"replies_from_station_zero", "replies come from station 0",
       edit_reply([](Bytes& reply, const Bytes&) { reply[0] = 0; }), "modbus_rtu/modes/serves",
       "station"},
      {"exceptions_from_station_zero", "exceptions come from station 0",
       edit_reply([](Bytes& reply, const Bytes&) {
         if (exception_of(reply)) reply[0] = 0;
       }),
       "modbus_ascii/examples/read_coil_status_refused", "station"},
  };
}

}  // namespace fieldproof::modbus_broken
