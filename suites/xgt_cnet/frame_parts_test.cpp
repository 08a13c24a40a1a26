#include "suites/xgt_cnet/frame_parts.hpp"

#include <gmock/gmock.h>

namespace fieldproof::xgt_cnet_suite {
namespace {

using testing::HasSubstr;

Bytes bytes(std::string_view hex) { return *from_hex(hex); }

std::string part(ByteView frame, std::string_view name) {
  for (const harness::Field& field : explain(frame))
    if (field.name == name)
      return field.problem.empty() ? field.text : field.text + " ! " + field.problem;
  return "absent";
}

// Cnet EN 7.1.5 (1)(e), request and ACK.
const Bytes request =
    bytes("05 30 31 72 53 53 30 32 30 36 25 4D 57 30 32 30 30 36 25 50 57 30 30 31 04 36 38");
const Bytes reply = bytes("06 30 31 72 53 53 30 32 30 32 31 32 33 34 30 32 35 36 37 38 03 34 43");

TEST(CnetExplain, NamesEveryPartOfTheManualsExample) {
  EXPECT_EQ(part(request, "station"), "01");
  EXPECT_EQ(part(request, "block count"), "02");
  EXPECT_EQ(part(request, "name 2"), "%PW001");
  EXPECT_EQ(part(request, "BCC"), "68");
  EXPECT_EQ(part(reply, "number of data 1"), "02");
  EXPECT_EQ(part(reply, "data 2"), "5678");
  EXPECT_EQ(part(reply, "BCC"), "4C");
}

TEST(CnetExplain, FieldsCoverTheFrameWithoutHoles) {
  for (const Bytes& frame : {request, reply}) {
    std::size_t at = 0;
    for (const harness::Field& field : explain(frame)) {
      EXPECT_EQ(field.offset, at) << field.name;
      at += field.size;
    }
    EXPECT_EQ(at, frame.size());
  }
}

TEST(CnetExplain, SaysWhatIsWrongWithABcc) {
  Bytes wrong = reply;
  wrong.back() = 'D';
  EXPECT_THAT(part(wrong, "BCC"), HasSubstr("4C is right"));
  Bytes without_tail = reply;
  without_tail[without_tail.size() - 2] = '4';
  without_tail.back() = '9';
  EXPECT_THAT(part(without_tail, "BCC"), HasSubstr("leaves the tail out"));
}

TEST(CnetExplain, ABccAfterAnUpperCaseCommandIsSurplus) {
  EXPECT_THAT(part(to_bytes("\x06"
                            "01WSS\x03"
                            "A4"),
                   "surplus"),
              HasSubstr("has none"));
}

TEST(CnetExplain, TranslatesErrorCodes) {
  EXPECT_EQ(part(to_bytes("\x15"
                          "01RSS1132\x03"),
                 "error code"),
            "1132 device memory: no such area, or not writable");
  EXPECT_THAT(part(to_bytes("\x15"
                            "01RSS9999\x03"),
                   "error code"),
              HasSubstr("not a code of Appendix 3.1"));
}

TEST(CnetExplain, MonitorFrames) {
  EXPECT_EQ(part(to_bytes("\x05"
                          "01X01RSS0106%MW000\x04"),
                 "registration number"),
            "01");
  EXPECT_EQ(part(to_bytes("\x05"
                          "01X01RSS0106%MW000\x04"),
                 "name"),
            "%MW000");
  EXPECT_EQ(part(to_bytes("\x06"
                          "10Y0901029183\x03"),
                 "data"),
            "9183")
      << "individual: with block count";
  EXPECT_EQ(part(to_bytes("\x06"
                          "10Y09049183AABB\x03"),
                 "data"),
            "9183AABB")
      << "continuous: without";
}

TEST(CnetExplain, AnyBytesAreReadWithoutHarm) {
  unsigned state = 7;
  for (int round = 0; round < 20'000; ++round) {
    Bytes frame;
    for (int i = 0; i < 24; ++i) {
      state = state * 1103515245u + 12345u;
      const std::string_view likely =
          "\x05\x06\x15\x04\x03"
          "0129rRwWXYSB%MW0F";
      frame.push_back((state >> 16) % 8 ? static_cast<Byte>(likely[(state >> 16) % likely.size()])
                                        : static_cast<Byte>(state >> 24));
    }
    std::size_t covered = 0;
    for (const harness::Field& field : explain(frame)) covered += field.size;
    EXPECT_LE(covered, frame.size());
    if (const auto length = frame_length(frame)) {
      EXPECT_GT(*length, 0u);
      EXPECT_LE(*length, frame.size());
    }
  }
}

TEST(FrameLength, EndsAtTheTailOrAfterTheBcc) {
  EXPECT_EQ(frame_length(request), request.size());
  EXPECT_EQ(frame_length(ByteView(request).first(request.size() - 1)), std::nullopt)
      << "one character of the BCC is missing";
  EXPECT_EQ(frame_length(to_bytes("\x05"
                                  "01RSS\x04")),
            7u);
  EXPECT_EQ(frame_length(to_bytes("\x05"
                                  "01RSS")),
            std::nullopt);
}

TEST(FrameLength, GarbageAndABrokenFrameEndAtTheNextHeader) {
  EXPECT_EQ(frame_length(to_bytes("xyz\x06")), 3u);
  EXPECT_EQ(frame_length(to_bytes("xyz")), std::nullopt);
  EXPECT_EQ(frame_length(to_bytes("\x06"
                                  "01rSS\x15"
                                  "01rSS")),
            6u);
  EXPECT_EQ(frame_length(to_bytes("\x06"
                                  "01rSS\x03\x06")),
            7u)
      << "the BCC is missing";
}

/// Cnet EN 7.1.3: the main command alone tells capitals from small letters. 40 is the BCC that Cnet
/// EN 11.2.4 prints for this request; four letters that are small add 4 x 20.
TEST(CnetFrameParts, LettersThatAreFreeArePlain) {
  const auto plain = [](std::string_view text) {
    const Bytes bytes = in_plain_letters(to_bytes(text));
    return std::string(bytes.begin(), bytes.end());
  };
  EXPECT_EQ(plain("\x05"
                  "01rss0104%mw0\x04"
                  "c0"),
            "\x05"
            "01rSS0104%MW0\x04"
            "40");
  EXPECT_EQ(plain("\x05"
                  "01Rss0104%mw0\x04"),
            "\x05"
            "01RSS0104%MW0\x04");
  EXPECT_EQ(plain("\x05"
                  "01rss0104%mw0\x04"
                  "c1"),
            "\x05"
            "01rss0104%mw0\x04"
            "c1")
      << "a wrong BCC";
}

TEST(CnetFrameParts, WhatIsMissingIsSaid) {
  const auto last = [](const std::string& text) { return explain(to_bytes(text)).back().problem; };
  EXPECT_EQ(last("\x05"
                 "01rSS0106%MW100"),
            "no EOT and no BCC follow");
  EXPECT_EQ(last("\x05"
                 "01RSS0106%MW100"),
            "no EOT follows");
  EXPECT_EQ(last("\x05"
                 "01rSS0106%MW100\x04"),
            "no BCC follows");
  EXPECT_EQ(last("\x05"
                 "01rSS0106%MW1"),
            "cut short: 4 of 6 characters");
  EXPECT_EQ(last("\x05"
                 "01RSS0106%MW100\x04"),
            "");
}

}  // namespace
}  // namespace fieldproof::xgt_cnet_suite
