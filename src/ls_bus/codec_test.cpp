#include "src/ls_bus/codec.hpp"

#include <gmock/gmock.h>

namespace fieldproof::ls_bus {
namespace {

constexpr auto address_first = LsWriteOrder::address_first, count_first = LsWriteOrder::count_first;

Bytes bytes(std::string_view hex) { return *from_hex(hex); }

// The examples of Cnet EN and KO 8.2: the manual prints the bytes but for the sum, which is added
// up by hand here.
const Bytes read_request = bytes("05 30 31 52 31 32 33 30 31 41 41 04");
const Bytes read_ack = bytes("06 30 31 52 31 32 33 34 37 44 04");
const Bytes read_nak = bytes("15 30 31 52 31 32 31 36 04");
const Bytes write_count_first = bytes("05 30 31 57 31 31 32 33 30 30 30 46 46 39 42 04");
const Bytes write_address_first = bytes("05 30 31 57 31 32 33 30 31 30 30 46 46 39 42 04");
const Bytes write_ack = bytes("06 30 31 57 30 30 46 46 41 34 04");
const Bytes write_nak = bytes("15 30 31 57 31 32 31 42 04");

/// ENQ, the body with its sum, EOT.
Bytes request(std::string_view body) {
  unsigned sum = 0;
  for (const char c : body) sum += static_cast<unsigned char>(c);
  return to_bytes('\x05' + std::string(body) + hex_number(sum & 0xFF, 2) + '\x04');
}

LsFault fault_of(std::string_view body, LsWriteOrder order = address_first) {
  return parse_ls_request(request(body), order).fault;
}

TEST(LsCodec, ReadsTheManualsRequests) {
  const LsRequest read = parse_ls_request(read_request, address_first);
  EXPECT_EQ(read.fault, LsFault::none);
  EXPECT_EQ(read.station, 1u);
  EXPECT_EQ(read.command, 'R');
  EXPECT_EQ(read.address, 0x1230u);
  EXPECT_EQ(read.count, 1u);
  for (const auto& [frame, order] :
       {std::pair{write_address_first, address_first}, {write_count_first, count_first}}) {
    const LsRequest write = parse_ls_request(frame, order);
    EXPECT_EQ(write.fault, LsFault::none);
    EXPECT_EQ(write.command, 'W');
    EXPECT_EQ(write.address, 0x1230u);
    EXPECT_EQ(write.count, 1u);
    EXPECT_EQ(write.data[0], 0x00FF);
  }
}

TEST(LsCodec, TheOrderOfAWriteIsNotGuessed) {
  // 1000, one word, 00FF; read the other way it is one word, 00FF, for 0001.
  EXPECT_EQ(parse_ls_request(request("01W1000100FF"), address_first).address, 0x1000u);
  EXPECT_EQ(parse_ls_request(request("01W1000100FF"), count_first).address, 0x0001u);
  EXPECT_EQ(parse_ls_request(read_request, count_first).address, 0x1230u)
      << "the order is that of writes alone";
}

TEST(LsCodec, WritesTheManualsFrames) {
  EXPECT_EQ(encode_ls_request({.station = 1, .command = 'R', .address = 0x1230, .count = 1},
                              address_first),
            read_request);
  const LsRequest write{
      .station = 1, .command = 'W', .address = 0x1230, .count = 1, .data = {0x00FF}};
  EXPECT_EQ(encode_ls_request(write, address_first), write_address_first);
  EXPECT_EQ(encode_ls_request(write, count_first), write_count_first);
  const std::uint16_t read_word = 0x1234, written_word = 0x00FF;
  EXPECT_EQ(encode_ls_ack(1, 'R', {&read_word, 1}), read_ack);
  EXPECT_EQ(encode_ls_ack(1, 'W', {&written_word, 1}), write_ack);
  EXPECT_EQ(encode_ls_nak(1, 'R', "12"), read_nak);
  EXPECT_EQ(encode_ls_nak(1, 'W', "12"), write_nak);
}

TEST(LsCodec, EightWordsFillTheLongestFrame) {
  LsRequest write{.station = 0xFE, .command = 'W', .address = 0x12F8, .count = 8};
  for (unsigned i = 0; i < 8; ++i) write.data[i] = static_cast<std::uint16_t>(0x1111 * i + 1);
  for (const LsWriteOrder order : {address_first, count_first}) {
    const Bytes frame = encode_ls_request(write, order);
    EXPECT_EQ(frame.size(), ls_max_frame);
    const LsRequest parsed = parse_ls_request(frame, order);
    EXPECT_EQ(parsed.fault, LsFault::none);
    EXPECT_EQ(parsed.station, write.station);
    EXPECT_EQ(parsed.address, write.address);
    EXPECT_EQ(parsed.data, write.data);
  }
}

TEST(LsCodec, EachFieldHasItsFault) {
  EXPECT_EQ(fault_of("01X12301"), LsFault::function);
  EXPECT_EQ(fault_of("01r12301"), LsFault::function);
  EXPECT_EQ(fault_of("01R12G01"), LsFault::address);
  EXPECT_EQ(fault_of("01R123"), LsFault::address);
  EXPECT_EQ(fault_of("01R1230"), LsFault::data);
  EXPECT_EQ(fault_of("01R12300"), LsFault::data);
  EXPECT_EQ(fault_of("01R12309"), LsFault::data);
  EXPECT_EQ(fault_of("01R1230G"), LsFault::data);
  EXPECT_EQ(fault_of("01R12308"), LsFault::none);
  EXPECT_EQ(fault_of("01R123012"), LsFault::data);
  EXPECT_EQ(fault_of("01W1230100F"), LsFault::data);
  EXPECT_EQ(fault_of("01W1230100FF0"), LsFault::data);
  EXPECT_EQ(fault_of("01W1230100FG"), LsFault::data);
  EXPECT_EQ(fault_of("01W1230200FF"), LsFault::data);
  EXPECT_EQ(fault_of("01W9" + std::string("1230") + std::string(36, '0'), count_first),
            LsFault::data);
  EXPECT_EQ(fault_of("01w1230100FF"), LsFault::function);
}

TEST(LsCodec, TheSumIsLookedAtFirst) {
  Bytes frame = request("01X12301");
  frame[frame.size() - 2] ^= 1;
  EXPECT_EQ(parse_ls_request(frame, address_first).fault, LsFault::frame);
  EXPECT_EQ(parse_ls_request(bytes("05 30 31 52 31 32 33 30 31 41 04"), address_first).fault,
            LsFault::frame)
      << "one digit is missing";
  EXPECT_EQ(parse_ls_request(bytes("05 30 31 52 31 32 33 30 31 61 61 04"), address_first).fault,
            LsFault::none)
      << "lower-case digits";
}

TEST(LsCodec, AFrameThatCannotBeAnsweredHasNoStation) {
  EXPECT_EQ(parse_ls_request(bytes("05 30 31 39 32 04"), address_first).station, std::nullopt)
      << "no command";
  EXPECT_EQ(parse_ls_request(bytes("05 04"), address_first).station, std::nullopt);
  EXPECT_EQ(parse_ls_request({}, address_first).station, std::nullopt);
  EXPECT_EQ(parse_ls_request(request("0GR12301"), address_first).station, std::nullopt);
  EXPECT_EQ(parse_ls_request(request("fFR12301"), address_first).station, 255u);
}

TEST(LsCodec, EachFaultHasItsCode) {
  EXPECT_EQ(ls_error_code(LsFault::none), "");
  EXPECT_EQ(ls_error_code(LsFault::frame), "FE");
  EXPECT_EQ(ls_error_code(LsFault::function), "IF");
  EXPECT_EQ(ls_error_code(LsFault::address), "IA");
  EXPECT_EQ(ls_error_code(LsFault::range), "IA");
  EXPECT_EQ(ls_error_code(LsFault::data), "ID");
  EXPECT_EQ(ls_error_code(LsFault::rights), "WM");
}

/// The frames in a stretch of bytes, as text without control characters.
std::vector<std::string> frames_in(std::string_view text) {
  LsReceiver receiver;
  std::vector<std::string> frames;
  for (const Byte b : to_bytes(text)) {
    if (!receiver.take(b)) continue;
    const std::string frame = to_text(receiver.frame());
    frames.push_back(frame.substr(1, frame.size() - 2));
  }
  return frames;
}

TEST(LsReceiver, FindsFrames) {
  using ::testing::ElementsAre;
  using ::testing::IsEmpty;
  EXPECT_THAT(frames_in("\x05"
                        "abc\x04"),
              ElementsAre("abc"));
  EXPECT_THAT(frames_in("noise\x04\x05"
                        "abc\x04"
                        "noise\x05"
                        "def\x04"),
              ElementsAre("abc", "def"));
  EXPECT_THAT(frames_in("\x05"
                        "abc\x04"
                        "def\x04"),
              ElementsAre("abc"))
      << "EOT ends it for good";
  EXPECT_THAT(frames_in("\x05"
                        "ab\x05"
                        "cd\x04"),
              ElementsAre("cd"))
      << "ENQ begins anew";
  EXPECT_THAT(frames_in("\x05"
                        "abc"),
              IsEmpty());
  EXPECT_THAT(frames_in("\x05"
                        "ab\x03\x04"),
              ElementsAre("ab\x03"));
}

TEST(LsReceiver, DropsWhatHasNoEnd) {
  const std::string longest(LsReceiver::buffer_size - 2, 'x');
  EXPECT_EQ(frames_in('\x05' + longest + '\x04').size(), 1u);
  EXPECT_EQ(frames_in('\x05' + longest + "x\x04").size(), 0u);
  EXPECT_EQ(frames_in('\x05' + longest +
                      "xyz\x05"
                      "abc\x04")
                .size(),
            1u);
}

TEST(LsReceiver, ResetForgetsTheFrameInProgress) {
  LsReceiver receiver;
  receiver.take(ls_enq);
  receiver.reset();
  EXPECT_FALSE(receiver.take(ls_eot));
}

}  // namespace
}  // namespace fieldproof::ls_bus
