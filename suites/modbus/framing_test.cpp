#include "suites/modbus/framing.hpp"

#include <gmock/gmock.h>

namespace fieldproof::modbus_suite {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

Bytes bytes(std::string_view hex) { return *from_hex(hex); }

std::string part(const Framing& framing, ByteView frame, std::string_view name) {
  for (const harness::Field& field : framing.explain(frame, Way::unknown))
    if (field.name == name)
      return field.problem.empty() ? field.text : field.text + " ! " + field.problem;
  return "absent";
}
std::string rtu_part(std::string_view hex, std::string_view name) {
  return part(rtu_framing(), bytes(hex), name);
}
std::string ascii_part(std::string_view text, std::string_view name) {
  return part(ascii_framing(), to_bytes(text), name);
}

// Published frames: Modbus over serial line 1.02, and the manual's examples (Cnet EN 9.4) with
// their CRC.
constexpr std::string_view published_request = "01 03 00 6B 00 03 74 17";
constexpr std::string_view published_reply = "01 03 06 13 12 3D 12 40 4F 46 48";
constexpr std::string_view published_ascii_request = ":0103006B00038E\r\n";

TEST(ExplainRtu, NamesThePartsOfTheManualsExamples) {
  EXPECT_EQ(rtu_part(published_request, "station"), "01");
  EXPECT_EQ(rtu_part(published_request, "function code"), "03 Read Holding Registers, request");
  EXPECT_EQ(rtu_part(published_request, "address"), "006B");
  EXPECT_EQ(rtu_part(published_request, "count"), "0003");
  EXPECT_EQ(rtu_part(published_request, "CRC"), "7417");
  EXPECT_EQ(rtu_part(published_reply, "function code"), "03 Read Holding Registers, reply");
  EXPECT_EQ(rtu_part(published_reply, "byte count"), "06");
  EXPECT_EQ(rtu_part(published_reply, "CRC"), "4648");
  EXPECT_EQ(rtu_part(published_reply, "data"), "13123D12404F");
}

TEST(ExplainRtu, TellsRequestsFromRepliesOfTheSameLength) {
  EXPECT_THAT(rtu_part("01 01 03 12 31 05 49 D8", "function code"), HasSubstr("reply"));
  EXPECT_THAT(rtu_part("01 01 00 13 00 13 8C 02", "function code"), HasSubstr("request"));
  EXPECT_THAT(rtu_part("01 01 03 00 00 01 FD 8E", "function code"), HasSubstr("reply"))
      << "both fit: 24 coils, or a request at 0300";
  EXPECT_THAT(rtu_part("01 0F 00 13 00 0A 24 09", "function code"), HasSubstr("reply"));
  EXPECT_THAT(rtu_part("01 0F 00 13 00 0A 02 CD 01 72 CB", "function code"), HasSubstr("request"));
}

TEST(ExplainRtu, SaysWhatIsWrongWithACrc) {
  EXPECT_THAT(rtu_part("01 03 00 6B 00 03 17 74", "CRC"), HasSubstr("7417 is right"));
  EXPECT_THAT(rtu_part("01 03 00 6B 00 03 17 74", "CRC"), HasSubstr("high byte first"));
  EXPECT_THAT(rtu_part("01 03 02 12 34", "data"), HasSubstr("no CRC follows"));
}

TEST(ExplainRtu, SaysWhatIsWrongWithCountsAndValues) {
  EXPECT_THAT(rtu_part("01 03 05 13 12 3D 12 40 4F 00 00", "byte count"),
              HasSubstr("6 bytes of data follow"));
  EXPECT_THAT(rtu_part("01 03 00 00 00 7E 00 00", "count"), HasSubstr("not 1 to 125 words"));
  EXPECT_THAT(rtu_part("01 05 00 08 00 01 00 00", "value"), HasSubstr("neither FF00"));
  EXPECT_THAT(rtu_part("01 0F 00 13 00 0A 01 CD 00 00", "byte count"), HasSubstr("02 is right"));
  EXPECT_THAT(rtu_part("01 07 00 00", "function code"), HasSubstr("not a function code"));
}

TEST(ExplainRtu, NamesExceptions) {
  EXPECT_EQ(rtu_part("01 83 02 C0 F1", "function code"), "83 exception to Read Holding Registers");
  EXPECT_EQ(rtu_part("01 83 02 C0 F1", "exception code"), "02 Illegal Address");
  EXPECT_THAT(rtu_part("01 83 09 00 00", "exception code"), HasSubstr("not a code"));
}

TEST(ExplainRtu, WhatFollowsACompleteFrameIsSurplus) {
  EXPECT_EQ(rtu_part("01 83 02 C0 F1 00", "CRC"), "C0F1");
  EXPECT_THAT(rtu_part("01 83 02 C0 F1 00", "surplus"), HasSubstr("00"));
}

TEST(ExplainAscii, NamesThePartsOfTheManualsExample) {
  EXPECT_EQ(ascii_part(published_ascii_request, "function code"),
            "03 Read Holding Registers, request");
  EXPECT_EQ(ascii_part(published_ascii_request, "address"), "006B");
  EXPECT_EQ(ascii_part(published_ascii_request, "LRC"), "8E");
  EXPECT_EQ(ascii_part(published_ascii_request, "tail"), "CR LF");
}

TEST(ExplainAscii, SaysWhatIsWrongWithTheFrame) {
  EXPECT_THAT(ascii_part(":0103006B00038F\r\n", "LRC"), HasSubstr("8E is right"));
  EXPECT_THAT(ascii_part(":0103006B000372\r\n", "LRC"), HasSubstr("the sum itself"));
  EXPECT_THAT(ascii_part(":0103006B00038e\r\n", "LRC"), HasSubstr("lower-case"));
  EXPECT_THAT(ascii_part(":0103006b00038E\r\n", "address"), HasSubstr("006b ! lower-case"));
  EXPECT_THAT(ascii_part(":0103006B00038\r\n", "odd digit"), HasSubstr("odd number"));
  EXPECT_THAT(ascii_part(":01030G6B00038E\r\n", "not hex"), HasSubstr("0G6B"));
  EXPECT_THAT(ascii_part(":0103006B00038E\r", "tail"), HasSubstr("CR LF"));
  EXPECT_THAT(ascii_part(":0103006B00038E", "LRC"), HasSubstr("no CR LF"));
  EXPECT_THAT(ascii_part("\r\n", "foreign bytes"), HasSubstr("colon"));
}

TEST(ModbusExplain, FieldsCoverTheFrameWithoutHoles) {
  for (const auto& [framing, frame] : {std::pair{&rtu_framing(), bytes(published_request)},
                                       {&rtu_framing(), bytes(published_reply)},
                                       {&rtu_framing(), bytes("01 0F 00 13 00 0A 02 CD 01 72 CB")},
                                       {&rtu_framing(), bytes("01 83 02 C0 F1 00")},
                                       {&ascii_framing(), to_bytes(published_ascii_request)},
                                       {&ascii_framing(), to_bytes(":01030G6B")}}) {
    std::size_t at = 0;
    for (const harness::Field& field : framing->explain(frame, Way::unknown)) {
      EXPECT_EQ(field.offset, at) << field.name;
      at += field.size;
    }
    EXPECT_EQ(at, frame.size()) << to_hex(frame);
  }
}

TEST(ModbusExplain, AnyBytesAreReadWithoutHarm) {
  unsigned state = 7;
  for (int round = 0; round < 20'000; ++round) {
    Bytes frame;
    for (unsigned i = 0; i < state % 23; ++i) {
      state = state * 1103515245u + 12345u;
      const std::string_view likely = ":01030F10\r\n\x01\x03\x0F\x10\x83";
      frame.push_back((state >> 16) % 8 ? static_cast<Byte>(likely[(state >> 16) % likely.size()])
                                        : static_cast<Byte>(state >> 24));
    }
    state = state * 1103515245u + 12345u;
    for (const Framing* framing : {&rtu_framing(), &ascii_framing()}) {
      std::size_t covered = 0;
      for (const harness::Field& field : framing->explain(frame, Way::unknown))
        covered += field.size;
      EXPECT_EQ(covered, frame.size()) << to_hex(frame);
      (void)framing->unwrap(frame);
      (void)framing->messages(frame);
      const auto length = framing->frame_length(frame);
      EXPECT_TRUE(!length || (*length > 0 && *length <= frame.size())) << to_hex(frame);
    }
  }
}

TEST(FrameLength, RtuEndsByFunctionCodeAndCrc) {
  const auto length = [](std::string_view hex) { return rtu_framing().frame_length(bytes(hex)); };
  EXPECT_EQ(length(published_request), 8u);
  EXPECT_EQ(length(published_reply), 11u);
  EXPECT_EQ(length("01 03 06 13 12 3D 12 40 4F 46"), std::nullopt);
  EXPECT_EQ(length("01 83 02 C0 F1 01 03"), 5u);
  EXPECT_EQ(length("01 83 02 C0 F0"), 5u) << "a wrong CRC ends a frame as well";
  EXPECT_EQ(length("55 AA 01 83 02 C0 F1"), 2u) << "foreign bytes first";
  EXPECT_EQ(length("01 07 41 E2"), 4u) << "of an unknown function: by its CRC";
  EXPECT_EQ(length("01 0F 00 13 00 0A 02 CD 01 72 CB"), 11u);
}

TEST(FrameLength, AsciiEndsAtLineFeedOrTheNextColon) {
  const auto length = [](std::string_view text) {
    return ascii_framing().frame_length(to_bytes(text));
  };
  EXPECT_EQ(length(published_ascii_request), published_ascii_request.size());
  EXPECT_EQ(length(":0103006B00038E\r"), std::nullopt);
  EXPECT_EQ(length(":01:0103"), 3u);
  EXPECT_EQ(length("xyz:0103"), 3u);
}

TEST(Wrap, AddsTheCheckThatThePublishedFramesHave) {
  EXPECT_EQ(rtu_framing().wrap(bytes("01 03 00 6B 00 03")), bytes(published_request));
  EXPECT_EQ(ascii_framing().wrap(bytes("01 03 00 6B 00 03")), to_bytes(published_ascii_request));
  EXPECT_EQ(rtu_framing().unwrap(bytes(published_request)), bytes("01 03 00 6B 00 03"));
  EXPECT_EQ(ascii_framing().unwrap(to_bytes(published_ascii_request)), bytes("01 03 00 6B 00 03"));
}

TEST(Messages, FindsEveryRequestThatADeviceCouldRead) {
  EXPECT_THAT(rtu_framing().messages(bytes("01 03 00 6B 00 03 74 17 01 06 00 08 00 03 48 09")),
              ElementsAre(bytes("01 03 00 6B 00 03"), bytes("01 06 00 08 00 03")));
  EXPECT_THAT(rtu_framing().messages(bytes("55 01 06 00 08 00 03 48 09")),
              ElementsAre(bytes("55 01 06 00 08 00 03 48 09"), bytes("01 06 00 08 00 03")))
      << "after noise";
  EXPECT_THAT(ascii_framing().messages(to_bytes(":0103:0106000800038E\r\n")),
              ElementsAre(bytes("01"), bytes("01 06 00 08 00 03")));
}

std::string tcp_part(std::string_view hex, std::string_view name) {
  return part(tcp_framing(), bytes(hex), name);
}

// Modbus messaging on TCP/IP 1.0b, and the header of FEnet EN 5.3.3.
constexpr std::string_view tcp_request = "15 01 00 00 00 06 FF 03 00 6B 00 03";

TEST(ExplainTcp, NamesHeaderAndMessage) {
  EXPECT_EQ(tcp_part(tcp_request, "transaction"), "1501");
  EXPECT_EQ(tcp_part(tcp_request, "protocol"), "0000");
  EXPECT_EQ(tcp_part(tcp_request, "length"), "0006");
  EXPECT_EQ(tcp_part(tcp_request, "unit"), "FF");
  EXPECT_EQ(tcp_part(tcp_request, "function code"), "03 Read Holding Registers, request");
  EXPECT_EQ(tcp_part(tcp_request, "count"), "0003");
}

TEST(ExplainTcp, SaysWhatIsWrong) {
  EXPECT_THAT(tcp_part("15 01 00 01 00 06 FF 03 00 6B 00 03", "protocol"), HasSubstr("! 0000 is"));
  EXPECT_THAT(tcp_part("15 01 00 00 00 07 FF 03 00 6B 00 03", "length"),
              HasSubstr("0006 is right"));
  EXPECT_THAT(tcp_part("15 01 00 00 00 00 FF 03 00 6B 00 03", "length"),
              HasSubstr("0006 is right"));
  EXPECT_THAT(tcp_part("15 01 00 00 00 05 FF 03 02 12 34 56", "surplus"), HasSubstr("56 !"));
  EXPECT_THAT(tcp_part("15 01 00", "protocol"), HasSubstr("cut short"));
  EXPECT_THAT(tcp_part("15 01", "transaction"), HasSubstr("ends here"));
}

TEST(SplitTcp, TheLengthAloneSaysWhereAFrameEnds) {
  const Bytes frame = bytes(tcp_request);
  for (std::size_t size = 0; size < frame.size(); ++size)
    EXPECT_EQ(tcp_framing().frame_length(ByteView(frame).first(size)), std::nullopt) << size;
  EXPECT_EQ(tcp_framing().frame_length(frame), 12u);
  EXPECT_EQ(tcp_framing().frame_length(bytes("15 01 00 00 00 02 FF 83 02 00")), 8u);
  EXPECT_EQ(tcp_framing().frame_length(bytes("15 01 00 00 00 00 FF")), 6u);
}

TEST(WrapTcp, CountsUnitAndPdu) {
  const Bytes frame = tcp_framing().wrap(bytes("01 03 00 00 00 01"));
  EXPECT_EQ(to_hex(ByteView(frame).subspan(2)), "00 00 00 06 01 03 00 00 00 01");
  EXPECT_EQ(tcp_framing().unwrap(frame), bytes("01 03 00 00 00 01"));
  EXPECT_EQ(tcp_framing().unwrap(bytes("15 01 00")), Bytes{});
}

TEST(MessagesTcp, AreAllThatADeviceCouldRead) {
  const auto messages = [](std::string_view hex) {
    std::vector<std::string> found;
    for (const Bytes& message : tcp_framing().messages(bytes(hex)))
      found.push_back(to_hex(message));
    return found;
  };
  EXPECT_THAT(messages(tcp_request), ElementsAre("FF 03 00 6B 00 03"));
  EXPECT_THAT(messages("00 01 00 00 00 02 01 07 00 02 00 00 00 06 01 06 00 01 12 34"),
              testing::IsSupersetOf({"01 07", "01 06 00 01 12 34"}));
  EXPECT_THAT(messages("00 01 00 00 FF FF 01 06 00 01 12 34"),
              testing::Contains("01 06 00 01 12 34"))
      << "a length that lies";
  EXPECT_THAT(messages("00 01 00 00 00 00 01 06 00 01 12 34"),
              testing::Contains("01 06 00 01 12 34"));
}

/// 01 03 12 31 05 has the form of a request of 3105 coils from 0312 on.
TEST(Framing, AReplyIsNoRequestWhereItIsKnownToBeOne) {
  const Bytes reply = rtu_framing().wrap(Bytes{0x01, 0x01, 0x03, 0x12, 0x31});
  const auto function = [&](Way way) { return rtu_framing().explain(reply, way).at(1).text; };
  EXPECT_EQ(function(Way::reply), "01 Read Coil Status, reply");
  EXPECT_EQ(function(Way::request), "01 Read Coil Status, request");
}

}  // namespace
}  // namespace fieldproof::modbus_suite
