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
  EXPECT_FALSE(request.fault) << describe(request.fault);
  EXPECT_EQ(to_hex(encoded(request)), wire);
}

void expect_printed_reply(std::string_view wire) {
  const Bytes bytes = *from_hex(wire);
  const XgtReply reply = parse_reply(bytes);
  EXPECT_FALSE(reply.fault) << describe(reply.fault);
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
  EXPECT_FALSE(r.fault) << describe(r.fault);
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
  EXPECT_FALSE(r.fault) << describe(r.fault);
  EXPECT_EQ(r.service, XgtService::register_monitor);
  EXPECT_EQ(r.content, XgtService::read_run);
  EXPECT_EQ(r.registration, 15u);
  EXPECT_EQ(r.block[0].name, "%MW000");
  EXPECT_EQ(r.count, 3u);
}

struct Faulty {
  const char* body;
  std::uint16_t code;
  const char* what;
};

/// What parsing alone can tell: area and range depend on the model (server_test.cpp).
TEST(XgtCodec, FaultsAreNamed) {
  const Faulty cases[] = {
      {"01RSS1105%MW10", 0x0003, "block count is more than 16 (NAK 0003)"},
      {"01RSSFF05%MW10", 0x0003, "block count is more than 16 (NAK 0003)"},
      {"01RSS0005%MW10", 0x0011, "block count is zero (NAK 0011)"},
      {"01RSS0G05%MW10", 0x0011, "block count is not hex (NAK 0011)"},
      {"01RSS", 0x0011, "block count is cut short (NAK 0011)"},
      {"01RSS0", 0x0011, "block count is cut short (NAK 0011)"},
      {"01RSS0111%MW00000000000010", 0x0004, "block 1, name length is more than 16 (NAK 0004)"},
      {"01RSS0100", 0x0004, "block 1, name length is zero (NAK 0004)"},
      {"01RSS01G5%MW10", 0x0011, "block 1, name length is not hex (NAK 0011)"},
      {"01RSS0105%MWM", 0x0011, "block 1, name is cut short (NAK 0011)"},
      {"01RSS0205%MW10", 0x0011, "block 2, name length is cut short (NAK 0011)"},
      {"01RSS0205%MW1011", 0x0004, "block 2, name length is more than 16 (NAK 0004)"},
      {"01RSS0105%MW10000", 0x1234, "surplus follows the last field (NAK 1234)"},
      {"01WSS0105%MW10AA", 0x0011, "block 1, data is cut short (NAK 0011)"},
      {"01WSS0105%MW10AA%5", 0x1432, "block 1, data is not hex (NAK 1432)"},
      {"01WSS0105%MX1011", 0x0011, "block 1, data is not 00 or 01 (NAK 0011)"},
      {"01WSS0105%MX100G", 0x1432, "block 1, data is not hex (NAK 1432)"},
      {"01WSS0105%MX10012", 0x1234, "surplus follows the last field (NAK 1234)"},
      {"01RSB05%MX1001", 0x0007,
       "name is of bits, which have no continuous read or write (NAK 0007)"},
      {"01RSB05%MW10%4", 0x0011, "number of data is not hex (NAK 0011)"},
      {"01RSB05%MW1000", 0x0011, "number of data is zero (NAK 0011)"},
      {"01RSB05%MW10", 0x0011, "number of data is cut short (NAK 0011)"},
      {"01RSB05%MW103D", 0x1232, "number of data is more than 60 words (NAK 1232)"},
      {"01RSB05%MB1079", 0x1232, "number of data is more than 60 words (NAK 1232)"},
      {"01RSB05%MD101F", 0x1232, "number of data is more than 60 words (NAK 1232)"},
      {"01RSB05%ML1010", 0x1232, "number of data is more than 60 words (NAK 1232)"},
      {"01WSB05%MW1040AA5512", 0x1232, "number of data is more than 60 words (NAK 1232)"},
      {"01WSB05%MW1002AA551", 0x0011, "data is cut short (NAK 0011)"},
      {"01WSB05%MW1001AA551", 0x1234, "surplus follows the last field (NAK 1234)"},
      {"01X10RSS0105%MW10", 0x0290, "registration number is not 00 to 0F (NAK 0290)"},
      {"01X0GRSS0105%MW10", 0x0290, "registration number is not two hex digits (NAK 0290)"},
      {"01X0", 0x0290, "registration number is not two hex digits (NAK 0290)"},
      {"01X00WSS0105%MW10", 0x0011, "registration format is neither RSS nor RSB (NAK 0011)"},
      {"01X00RS", 0x0011, "registration format is neither RSS nor RSB (NAK 0011)"},
      {"01X00RSS0105%MW100", 0x1234, "surplus follows the last field (NAK 1234)"},
      {"01Y10", 0x0190, "registration number is not 00 to 0F (NAK 0190)"},
      {"01Y", 0x0190, "registration number is not two hex digits (NAK 0190)"},
      {"01Y0000", 0x1234, "surplus follows the last field (NAK 1234)"},
      {"01RSD", 0, "command type is neither SS nor SB"},
      {"01QSS", 0, "command is not R, W, X or Y"},
      {"G1RSS", 0, "station is not two hex digits"},
      {"0", 0, "station is not two hex digits"},
  };
  for (const Faulty& c : cases) {
    const Bytes frame = enq(c.body);
    const XgtFault fault = parse_request(frame).fault;
    EXPECT_EQ(fault.code, c.code) << c.body;
    EXPECT_EQ(describe(fault), c.what) << c.body;
  }
}

TEST(XgtCodec, FaultsOfTheEnvelope) {
  const auto what = [](std::string_view hex) {
    const Bytes bytes = *from_hex(hex);
    return describe(parse_request(bytes).fault);
  };
  EXPECT_EQ(what(""), "header is not ENQ");
  EXPECT_EQ(what("06 30 31 52 53 53 04"), "header is not ENQ");
  EXPECT_EQ(what("05"), "tail EOT is missing");
  EXPECT_EQ(what("05 30 31 79 30 31"), "tail EOT is missing");
  EXPECT_EQ(what("05 30 31 79 30 31 04"), "BCC is missing");
  EXPECT_EQ(what("05 30 31 79 30 31 04 34"), "BCC is missing");
  EXPECT_EQ(what("05 30 31 79 30 31 04 34 35"), "BCC is wrong");
  EXPECT_EQ(what("05 30 31 79 30 31 04 34 34"), "the frame is right");
}

TEST(XgtCodec, BccDigitsInEitherCase) {
  const Bytes upper = enq("0ArSB06%MW00002");
  Bytes lower = upper;
  ASSERT_EQ(lower[lower.size() - 2], 'A');
  lower[lower.size() - 2] = 'a';
  EXPECT_FALSE(parse_request(upper).fault);
  EXPECT_FALSE(parse_request(lower).fault);
}

TEST(XgtCodec, OffsetsPointAtTheField) {
  const Bytes frame = enq("01RSS0205%MW1005$MW10x");
  const XgtRequest r = parse_request(frame);
  EXPECT_EQ(r.fault.field, "surplus");
  EXPECT_EQ(frame[r.fault.offset], 'x');
  EXPECT_EQ(r.block[1].name, "$MW10");
}

TEST(XgtCodec, FieldsOfReplies) {
  const Bytes two = ack("01rSS0201AA01BB");
  XgtReply r = parse_reply(two);
  EXPECT_FALSE(r.fault) << describe(r.fault);
  EXPECT_TRUE(r.ack);
  ASSERT_EQ(r.blocks, 2u);
  EXPECT_EQ(r.data[0], "AA");
  EXPECT_EQ(r.data[1], "BB");
  const Bytes refused =
      nak("FFW"
          "SB1132");
  r = parse_reply(refused);
  EXPECT_FALSE(r.fault) << describe(r.fault);
  EXPECT_FALSE(r.ack);
  EXPECT_EQ(r.station, 255u);
  EXPECT_EQ(r.error, 0x1132);
}

TEST(XgtCodec, FaultsOfReplies) {
  const auto what = [](const Bytes& bytes) { return describe(parse_reply(bytes).fault); };
  EXPECT_EQ(what(ack("01RSS0102123")), "block 1, data is cut short");
  EXPECT_EQ(what(ack("01RSS01021234A")), "surplus follows the last block");
  EXPECT_EQ(what(ack("01RSS0102123G")), "block 1, data is not hex");
  EXPECT_EQ(what(ack("01RSS01G21234")), "block 1, number of data is not two hex digits");
  EXPECT_EQ(what(ack("01RSS00")), "block count is not 01 to 10");
  EXPECT_EQ(what(ack("01RSS11")), "block count is not 01 to 10");
  EXPECT_EQ(what(ack("01WSS00")), "surplus follows the last field");
  EXPECT_EQ(what(ack("01X0G")), "command is not RSS, RSB, WSS, WSB, X or Y");
  EXPECT_EQ(what(nak("01RSS113")), "error code is not four hex digits");
  EXPECT_EQ(what(nak("01RSS11320")), "surplus follows the error code");
  EXPECT_EQ(what(enq("01RSS")), "header is not ACK or NAK");
}

TEST(XgtCodec, SixteenBlocksAndNames) {
  std::string body = "01wSS10";
  for (unsigned i = 0; i < 16; ++i)
    body += std::string("10%ML000000000000") + hex_char(i % 10) + "0123456789ABCDEF";
  const Bytes frame = enq(body);
  EXPECT_EQ(frame.size(), 1u + 7 + 16 * (2 + 16 + 16) + 3);  // 555
  const XgtRequest r = parse_request(frame);
  EXPECT_FALSE(r.fault) << describe(r.fault);
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
        ASSERT_LE(parse_request(damaged).fault.offset, frame.size()) << to_hex(damaged);
        ASSERT_LE(parse_reply(damaged).fault.offset, frame.size()) << to_hex(damaged);
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
    ASSERT_LE(request.fault.offset, bytes.size() + 6);
  }
}

}  // namespace
}  // namespace fieldproof::xgt_cnet
