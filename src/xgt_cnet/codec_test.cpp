#include "src/xgt_cnet/codec.hpp"

#include <gtest/gtest.h>

#include <random>

#include "src/xgt_cnet/test_frames.hpp"

namespace fieldproof::xgt_cnet {
namespace {

using test::ack;
using test::enq;
using test::nak;

Bytes encoded(const XgtRequest& request) {
  Bytes bytes;
  encode_request(request, bytes);
  return bytes;
}

Bytes encoded(const XgtReply& reply) {
  Bytes bytes;
  encode_reply(reply, bytes);
  return bytes;
}

/// The bytes that the manual prints for a request parse without fault and encode to themselves.
void expect_printed_request(std::string_view wire) {
  const Bytes bytes = *from_hex(wire);
  const XgtRequest request = parse_request(bytes);
  EXPECT_FALSE(request.fault);
  EXPECT_EQ(to_hex(encoded(request)), wire);
}

void expect_printed_reply(std::string_view wire) {
  const Bytes bytes = *from_hex(wire);
  const XgtReply reply = parse_reply(bytes);
  EXPECT_FALSE(reply.fault);
  EXPECT_EQ(to_hex(encoded(reply)), wire);
}

// The frames below are typed from the 'ASCII value' rows of Cnet EN 7.1.5 with the errata of the
// vectors applied (names and tails printed wrong); BCC added by hand where the manual prints none.
TEST(XgtCodec, PrintedRequests) {
  expect_printed_request(
      "05 32 30 72 53 53 30 31 30 36 25 4D 57 31 30 30 04 41 34");  // (1)(b), BCC A4 printed
  expect_printed_request("05 32 30 52 53 53 30 31 30 36 25 4D 57 31 30 30 04");
  expect_printed_request(
      "05 30 31 72 53 53 30 32 30 36 25 4D 57 30 32 30 30 36 25 50 57 30 30 31 04 36 38");  // (1)(e)
  expect_printed_request("05 31 30 72 53 42 30 36 25 4D 57 31 30 30 30 35 04 39 36");  // (2)(b)
  expect_printed_request("05 30 41 72 53 42 30 36 25 4D 57 30 30 30 30 32 04 41 32");  // (2)(e)
  expect_printed_request(
      "05 32 30 77 53 53 30 31 30 36 25 4D 57 31 30 30 30 30 45 32 04 38 30");  // (3)(b)
  expect_printed_request(
      "05 30 31 77 53 53 30 31 30 36 25 4D 57 32 33 30 30 30 46 46 04 39 38");  // (3)(e)
  expect_printed_request(
      "05 31 30 77 53 42 30 36 25 4D 57 31 30 30 30 32 31 31 31 31 32 32 32 32 04 32 34");  // (4)(b)
  expect_printed_request(
      "05 30 31 77 53 42 30 36 25 44 57 30 30 30 30 31 41 41 31 35 04 37 35");  // (4)(e)
  expect_printed_request(
      "05 30 31 78 30 31 52 53 53 30 31 30 36 25 4D 57 30 30 30 04 35 42");  // (5)(e)
  expect_printed_request("05 30 31 58 30 31 52 53 53 30 31 30 36 25 4D 57 30 30 30 04");
  expect_printed_request("05 31 30 79 30 39 04 34 43");  // (6)(b)
  expect_printed_request("05 30 31 59 30 31 04");        // (6)(e)
  expect_printed_request(
      "05 30 31 72 53 53 30 31 30 34 25 4D 57 30 04 34 30");  // 11.2.4, BCC 40 printed
}

TEST(XgtCodec, PrintedReplies) {
  expect_printed_reply("06 32 30 72 53 53 30 31 30 32 41 39 46 33 03 33 39");  // (1)(c)
  expect_printed_reply(
      "06 30 31 72 53 53 30 32 30 32 31 32 33 34 30 32 35 36 37 38 03 34 43");             // (1)(e)
  expect_printed_reply("06 31 30 72 53 42 30 31 30 32 31 31 32 32 03 46 41");              // (2)(c)
  expect_printed_reply("06 30 41 72 53 42 30 31 30 34 31 32 33 34 35 36 37 38 03 45 41");  // (2)(e)
  expect_printed_reply("06 32 30 77 53 53 03 38 38");                                      // (3)(c)
  expect_printed_reply("06 31 30 57 53 42 03");                                            // (4)(c)
  expect_printed_reply("06 31 30 78 30 39 03 34 42");                                      // (5)(c)
  expect_printed_reply("06 31 30 79 30 39 30 31 30 32 39 31 38 33 03 45 34");        // (6)(c) 1)
  expect_printed_reply("06 31 30 79 30 39 30 34 39 31 38 33 41 41 42 42 03 38 42");  // (6)(c) 2)
  expect_printed_reply("06 30 31 79 30 31 30 31 30 32 32 33 34 32 03 44 32");        // (6)(e)
  expect_printed_reply("15 32 30 72 53 53 31 31 33 32 03 35 39");                    // (1)(d)
  expect_printed_reply("15 32 30 57 53 53 34 32 35 32 03");                          // (3)(d)
  expect_printed_reply("15 31 30 78 30 39 31 31 33 32 03 32 31");                    // (5)(d)
}

TEST(XgtCodec, FieldsOfARequest) {
  const Bytes frame =
      enq("1FwSs0206%MW230"
          "00FF"
          "05%mw10"
          "1a2B");
  const XgtRequest r = parse_request(frame);
  EXPECT_FALSE(r.fault);
  EXPECT_EQ(r.station, 0x1Fu);
  EXPECT_EQ(r.command, 'w');
  EXPECT_EQ(r.kind, "Ss");
  EXPECT_EQ(r.service, XgtService::write_blocks);
  ASSERT_EQ(r.blocks, 2u);
  EXPECT_EQ(r.block[0].name, "%MW230");
  EXPECT_EQ(r.block[0].data, "00FF");
  EXPECT_EQ(r.block[1].name, "%mw10");
  EXPECT_EQ(r.block[1].data, "1a2B");
}

TEST(XgtCodec, FieldsOfARegistration) {
  const Bytes frame = enq("01X0frsb06%MW00003");
  const XgtRequest r = parse_request(frame);
  EXPECT_FALSE(r.fault);
  EXPECT_EQ(r.service, XgtService::register_monitor);
  EXPECT_EQ(r.content, XgtService::read_run);
  EXPECT_EQ(r.registration, 15u);
  EXPECT_EQ(r.block[0].name, "%MW000");
  EXPECT_EQ(r.count, 3u);
}

struct Faulty {
  const char* body;
  std::uint16_t code;
  XgtCheck check;
};

/// What parsing alone can tell: area and range depend on the model (server_test.cpp).
TEST(XgtCodec, FaultsAreNamed) {
  const Faulty cases[] = {
      {"01RSS1105%MW10", 0x0003, XgtCheck::block_count},
      {"01RSSFF05%MW10", 0x0003, XgtCheck::block_count},
      {"01RSS0005%MW10", 0x0011, XgtCheck::block_count},
      {"01RSS0G05%MW10", 0x0011, XgtCheck::block_count},
      {"01RSS", 0x0011, XgtCheck::block_count},
      {"01RSS0", 0x0011, XgtCheck::block_count},
      {"01RSS0111%MW00000000000010", 0x0004, XgtCheck::name_length},
      {"01RSS0100", 0x0004, XgtCheck::name_length},
      {"01RSS01G5%MW10", 0x0011, XgtCheck::name_length},
      {"01RSS0105%MWM", 0x0011, XgtCheck::name_length},
      {"01RSS0205%MW10", 0x0011, XgtCheck::name_length},
      {"01RSS0205%MW1011", 0x0004, XgtCheck::name_length},
      {"01RSS0105%MW10000", 0x1234, XgtCheck::surplus},
      {"01WSS0105%MW10AA", 0x0011, XgtCheck::data},
      {"01WSS0105%MW10AA%5", 0x1432, XgtCheck::data},
      {"01WSS0105%MX1011", 0x0011, XgtCheck::bit_value},
      {"01WSS0105%MX100G", 0x1432, XgtCheck::data},
      {"01WSS0105%MX10012", 0x1234, XgtCheck::surplus},
      {"01RSB05%MX1001", 0x0007, XgtCheck::type},
      {"01RSB05%MW10%4", 0x0011, XgtCheck::count},
      {"01RSB05%MW1000", 0x0011, XgtCheck::count},
      {"01RSB05%MW10", 0x0011, XgtCheck::count},
      {"01RSB05%MW103D", 0x1232, XgtCheck::count},
      {"01RSB05%MB1079", 0x1232, XgtCheck::count},
      {"01RSB05%MD101F", 0x1232, XgtCheck::count},
      {"01RSB05%ML1010", 0x1232, XgtCheck::count},
      {"01WSB05%MW1040AA5512", 0x1232, XgtCheck::count},
      {"01WSB05%MW1002AA551", 0x0011, XgtCheck::data},
      {"01WSB05%MW1001AA551", 0x1234, XgtCheck::surplus},
      {"01X10RSS0105%MW10", 0x0290, XgtCheck::registration_number},
      {"01X0GRSS0105%MW10", 0x0290, XgtCheck::registration_number},
      {"01X0", 0x0290, XgtCheck::registration_number},
      {"01X00WSS0105%MW10", 0x0011, XgtCheck::registration_content},
      {"01X00RS", 0x0011, XgtCheck::registration_content},
      {"01X00RSS0105%MW100", 0x1234, XgtCheck::surplus},
      {"01Y10", 0x0190, XgtCheck::registration_number},
      {"01Y", 0x0190, XgtCheck::registration_number},
      {"01Y0000", 0x1234, XgtCheck::surplus},
      {"01RSD", 0, XgtCheck::command},
      {"01QSS", 0, XgtCheck::command},
      {"G1RSS", 0, XgtCheck::station},
      {"0", 0, XgtCheck::station},
  };
  for (const Faulty& c : cases) {
    const Bytes frame = enq(c.body);
    const XgtFault fault = parse_request(frame).fault;
    EXPECT_EQ(fault.code, c.code) << c.body;
    EXPECT_EQ(fault.check, c.check) << c.body;
  }
}

TEST(XgtCodec, FaultsOfTheEnvelope) {
  const auto check = [](std::string_view hex) { return parse_request(*from_hex(hex)).fault.check; };
  EXPECT_EQ(check(""), XgtCheck::head);
  EXPECT_EQ(check("06 30 31 52 53 53 04"), XgtCheck::head);
  EXPECT_EQ(check("05"), XgtCheck::tail);
  EXPECT_EQ(check("05 30 31 79 30 31"), XgtCheck::tail);
  EXPECT_EQ(check("05 30 31 79 30 31 04"), XgtCheck::bcc);
  EXPECT_EQ(check("05 30 31 79 30 31 04 34"), XgtCheck::bcc);
  EXPECT_EQ(check("05 30 31 79 30 31 04 34 35"), XgtCheck::bcc);
  EXPECT_EQ(check("05 30 31 79 30 31 04 34 34"), XgtCheck::none);
}

TEST(XgtCodec, BccDigitsInEitherCase) {
  const Bytes upper = enq("0ArSB06%MW00002");
  Bytes lower = upper;
  ASSERT_EQ(lower[lower.size() - 2], 'A');
  lower[lower.size() - 2] = 'a';
  EXPECT_FALSE(parse_request(upper).fault);
  EXPECT_FALSE(parse_request(lower).fault);
}

TEST(XgtCodec, FieldsOfReplies) {
  const Bytes two = ack("01rSS0201AA01BB");
  XgtReply r = parse_reply(two);
  EXPECT_FALSE(r.fault);
  EXPECT_TRUE(r.ack);
  ASSERT_EQ(r.blocks, 2u);
  EXPECT_EQ(r.data[0], "AA");
  EXPECT_EQ(r.data[1], "BB");
  const Bytes refused =
      nak("FFW"
          "SB1132");
  r = parse_reply(refused);
  EXPECT_FALSE(r.fault);
  EXPECT_FALSE(r.ack);
  EXPECT_EQ(r.station, 255u);
  EXPECT_EQ(r.error, 0x1132);
}

TEST(XgtCodec, FaultsOfReplies) {
  const auto check = [](const Bytes& bytes) { return parse_reply(bytes).fault.check; };
  EXPECT_EQ(check(ack("01RSS0102123")), XgtCheck::count);
  EXPECT_EQ(check(ack("01RSS01021234A")), XgtCheck::surplus);
  EXPECT_EQ(check(ack("01RSS0102123G")), XgtCheck::data);
  EXPECT_EQ(check(ack("01RSS01G21234")), XgtCheck::count);
  EXPECT_EQ(check(ack("01RSS00")), XgtCheck::block_count);
  EXPECT_EQ(check(ack("01RSS11")), XgtCheck::block_count);
  EXPECT_EQ(check(ack("01WSS00")), XgtCheck::surplus);
  EXPECT_EQ(check(ack("01X0G")), XgtCheck::command);
  EXPECT_EQ(check(nak("01RSS113")), XgtCheck::count);
  EXPECT_EQ(check(nak("01RSS113G")), XgtCheck::data);
  EXPECT_EQ(check(nak("01RSS11320")), XgtCheck::surplus);
  EXPECT_EQ(check(enq("01RSS")), XgtCheck::head);
}

/// What a fault makes of the rest of a frame never hides it.
TEST(XgtCodec, TheFaultInFrontIsTold) {
  const auto code = [](std::string_view body) { return parse_request(enq(body)).fault.code; };
  EXPECT_EQ(code("01RSS0205%MW1000"), 0x0004);
  EXPECT_EQ(code("01RSB00"), 0x0004);
  EXPECT_EQ(code("01QSS00"), 0);
}

TEST(XgtCodec, SixteenBlocksAndNames) {
  std::string body = "01wSS10";
  for (unsigned i = 0; i < 16; ++i)
    body += std::string("10%ML000000000000") + hex_char(i % 10) + "0123456789ABCDEF";
  const Bytes frame = enq(body);
  EXPECT_EQ(frame.size(), 1u + 7 + 16 * (2 + 16 + 16) + 3);  // 555
  const XgtRequest r = parse_request(frame);
  EXPECT_FALSE(r.fault);
  EXPECT_EQ(r.blocks, 16u);
  EXPECT_EQ(encoded(r), frame);
}

/// Every frame cut at every length (always a fault), and with every byte changed, is parsed in a
/// buffer of exactly its size, so that a sanitizer sees any byte read past it.
TEST(XgtCodec, DamagedFramesNeverReadPastTheEnd) {
  const Bytes frames[] = {enq("01rSS0206%MW02006%PW001"),
                          enq("01wSB06%DW00002AA15BB26"),
                          enq("01x01RSB06%MW00002"),
                          enq("01y01"),
                          ack("01rSS0202123402"
                              "5678"),
                          nak("01rSS1132"),
                          ack("01y01049183AABB")};
  for (const Bytes& frame : frames) {
    for (std::size_t size = 0; size < frame.size(); ++size) {
      const Bytes cut(frame.begin(), frame.begin() + static_cast<std::ptrdiff_t>(size));
      EXPECT_TRUE(parse_request(cut).fault) << to_hex(cut);
      EXPECT_TRUE(parse_reply(cut).fault) << to_hex(cut);
    }
    for (std::size_t at = 0; at < frame.size(); ++at) {
      for (int value = 0; value < 256; ++value) {
        Bytes damaged = frame;
        damaged[at] = static_cast<Byte>(value);
        ASSERT_LE(parse_request(damaged).blocks, xgt_max_blocks) << to_hex(damaged);
        ASSERT_LE(parse_reply(damaged).blocks, xgt_max_blocks) << to_hex(damaged);
      }
    }
  }
}

TEST(XgtCodec, RandomBytesNeverReadPastTheEnd) {
  std::mt19937 random(20140301);
  constexpr std::string_view likely =
      "\x05\x06\x15\x04\x03"
      "01rRwWxXyYSSSB%MWXBDL0123456789ABCDEF";
  for (int i = 0; i < 100'000; ++i) {
    Bytes bytes(random() % 60);
    for (Byte& b : bytes)
      b = random() % 4 == 0 ? static_cast<Byte>(random())
                            : static_cast<Byte>(likely[random() % likely.size()]);
    const XgtRequest request = parse_request(bytes);
    const XgtReply reply = parse_reply(bytes);
    ASSERT_LE(request.blocks, xgt_max_blocks);
    ASSERT_LE(reply.blocks, xgt_max_blocks);
  }
}

}  // namespace
}  // namespace fieldproof::xgt_cnet
