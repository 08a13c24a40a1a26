// Faults that show in one byte or digit of a check, beside a frame, or in one bit of an address.
#include <fmt/format.h>

#include <deque>

#include "suites/modbus/broken/faults.hpp"

namespace fieldproof::modbus_broken {

namespace {

using modbus::ModbusMode;

/// Where the check begins, from the end of the frame: two bytes, or two digits before CR LF.
std::size_t check_at(ModbusMode mode) { return mode == ModbusMode::rtu ? 2 : 4; }

/// The frame with its right check; what is too short stays as it is.
Bytes with_right_check(const Bytes& frame, const GoodModbus& plc) {
  const std::size_t from = check_at(plc.mode());
  if (frame.size() < from + 5) return frame;
  if (plc.mode() == ModbusMode::rtu) return plc.frame(ByteView(frame).first(frame.size() - from));
  const auto bytes = from_hex(to_text(ByteView(frame).subspan(1, frame.size() - from - 1)));
  return bytes ? plc.frame(*bytes) : frame;
}

/// A request whose check is right in this byte or digit is taken for right.
MakeBehaviour compares_one(std::size_t part) {
  return answer_frame([part](const Bytes& frame, GoodModbus& plc) {
    const Bytes right = with_right_check(frame, plc);
    if (right.size() != frame.size()) return plc.answer(frame);
    const std::size_t at = frame.size() - check_at(plc.mode()) + part;
    return plc.answer(frame[at] == right[at] ? right : frame);
  });
}

/// A frame that is right but for the byte before or behind it is taken.
MakeBehaviour passes_over(bool before) {
  return answer_frame([before](const Bytes& frame, GoodModbus& plc) {
    const Bytes reply = plc.answer(frame);
    if (!reply.empty() || frame.size() < 5) return reply;
    return plc.answer(before ? Bytes(frame.begin() + 1, frame.end())
                             : Bytes(frame.begin(), frame.end() - 1));
  });
}

/// Reads of one function code look at the area of another.
MakeBehaviour reads_as(Byte function, Byte other) {
  return answer_with([=](const Bytes& request, GoodModbus& plc) {
    if (function_of(request) != function) return plc.ask(request);
    Bytes misread = request;
    misread[1] = other;
    Bytes reply = plc.ask(misread);
    if (reply.size() > 1) reply[1] = static_cast<Byte>(function | (reply[1] & 0x80));
    return reply;
  });
}

/// A write of words whose byte count is odd is taken for the one that was meant.
Bytes odd_count_forgiven(const Bytes& request, GoodModbus& plc) {
  const Bytes reply = plc.ask(request);
  if (function_of(request) != 0x10 || exception_of(reply) == 0 || request.size() < 8 ||
      request[6] % 2 == 0)
    return reply;
  Bytes even = request;
  const unsigned count = word_at(request, count_at);
  even[6] = static_cast<Byte>(2 * count);
  even.resize(7 + 2 * count);
  return plc.ask(even);
}

/// Data addresses of reads of bits, or of words, never have this bit.
MakeBehaviour loses_address_bit(bool bits, unsigned bit) {
  return answer_with([=](const Bytes& request, GoodModbus& plc) {
    Bytes misread = request;
    if (is_read(function_of(request)) && is_bits(function_of(request)) == bits)
      put_word(misread, address_at, word_at(request, address_at) & ~(1U << bit));
    return plc.ask(misread);
  });
}

std::string_view text(std::string one) {
  static std::deque<std::string> texts;
  return texts.emplace_back(std::move(one));
}

/// One fault a bit of the data address, by the size of an area: 10240 words, 16384 bits.
void add_address_bits(const std::string& mode, std::vector<Fault>& result) {
  for (const bool bits : {true, false})
    for (unsigned bit = 0; bit < 14; ++bit)
      result.push_back(
          {text(fmt::format("{}_{}_without_address_bit_{}", mode, bits ? "bits" : "words", bit)),
           text(fmt::format("data address {:04X} is taken for 0000", 1U << bit)),
           loses_address_bit(bits, bit),
           text(fmt::format("modbus_{}/addressing/{}", mode,
                            bits ? "each_bit_of_bits/f01" : "each_bit_of_words/f03")),
           "data", broken::in_process});
}

}  // namespace

std::vector<Fault> narrow_faults() {
  constexpr auto alone = broken::in_process;
  std::vector<Fault> result{
      {"crc_first_byte_alone", "of the CRC of requests the first byte alone is compared",
       compares_one(0), "modbus_rtu/line/crc_one_byte/second", "silence", alone},
      {"crc_second_byte_alone", "of the CRC of requests the second byte alone is compared",
       compares_one(1), "modbus_rtu/line/wrong_check/f06", "silence", alone},
      {"lrc_first_digit_alone", "of the LRC of requests the first digit alone is compared",
       compares_one(0), "modbus_ascii/line/lrc_one_digit/second", "silence", alone},
      {"lrc_second_digit_alone", "of the LRC of requests the second digit alone is compared",
       compares_one(1), "modbus_ascii/line/lrc_one_digit/first", "silence", alone},
      {"byte_before_passed_over", "a byte right before a right frame is passed over",
       passes_over(true), "modbus_rtu/line/noise_before/n00", "silence", alone},
      {"byte_behind_passed_over", "a byte right behind a right frame is passed over",
       passes_over(false), "modbus_rtu/line/noise_behind/n55", "silence", alone},
      {"odd_byte_count_accepted", "an odd byte count of 10 is taken for the even one",
       answer_with(odd_count_forgiven), "modbus_rtu/exceptions/words_odd", "function code", alone},
      {"odd_byte_count_accepted_in_ascii", "an odd byte count of 10 is taken for the even one",
       answer_with(odd_count_forgiven), "modbus_ascii/exceptions/words_odd", "function code",
       alone}};
  for (const std::string mode : {"rtu", "ascii"}) {
    result.push_back({text(mode + "_inputs_from_the_coils"), "FC 02 reads what FC 01 reads",
                      reads_as(0x02, 0x01), text("modbus_" + mode + "/data/bits_02/a3_n8"), "data",
                      alone});
    result.push_back({text(mode + "_input_words_from_the_outputs"), "FC 04 reads what FC 03 reads",
                      reads_as(0x04, 0x03), text("modbus_" + mode + "/data/words_04/a0_n2"), "data",
                      alone});
    add_address_bits(mode, result);
  }
  return result;
}

}  // namespace fieldproof::modbus_broken
