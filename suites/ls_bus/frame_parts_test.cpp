#include "suites/ls_bus/frame_parts.hpp"

#include <gmock/gmock.h>

#include "suites/ls_bus/memory_requests.hpp"

namespace fieldproof::ls_bus_suite {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

Bytes bytes(std::string_view hex) { return *from_hex(hex); }

std::string part(ByteView frame, std::string_view name) {
  for (const harness::Field& field : explain(frame))
    if (field.name == name)
      return field.problem.empty() ? field.text : field.text + " ! " + field.problem;
  return "absent";
}

// The examples of Cnet EN and KO 8.2; the sums are added up by hand.
const Bytes read_request = bytes("05 30 31 52 31 32 33 30 31 41 41 04");
const Bytes read_ack = bytes("06 30 31 52 31 32 33 34 37 44 04");
const Bytes write_count_first = bytes("05 30 31 57 31 31 32 33 30 30 30 46 46 39 42 04");
const Bytes write_nak = bytes("15 30 31 57 31 32 31 42 04");

TEST(LsExplain, NamesEveryPartOfTheManualsExamples) {
  EXPECT_EQ(part(read_request, "station"), "01");
  EXPECT_EQ(part(read_request, "command"), "R");
  EXPECT_EQ(part(read_request, "address"), "1230");
  EXPECT_EQ(part(read_request, "count"), "1");
  EXPECT_EQ(part(read_request, "SUM"), "AA");
  EXPECT_EQ(part(read_request, "tail"), "EOT");
  EXPECT_EQ(part(read_ack, "data"), "1234");
  EXPECT_EQ(part(read_ack, "SUM"), "7D");
  EXPECT_THAT(part(write_nak, "error code"), HasSubstr("12"));
  for (const Bytes& frame : {read_request, read_ack, write_count_first, write_nak})
    for (const harness::Field& field : explain(frame))
      EXPECT_THAT(field.problem, IsEmpty()) << field.name;
}

TEST(LsExplain, FieldsCoverTheFrameWithoutHoles) {
  for (const Bytes& frame : {read_request, read_ack, write_count_first, write_nak,
                             bytes("05 30 31 52 04"), bytes("06 04"), bytes("05")}) {
    std::size_t at = 0;
    for (const harness::Field& field : explain(frame)) {
      EXPECT_EQ(field.offset, at) << field.name << " of " << to_hex(frame);
      at += field.size;
    }
    EXPECT_EQ(at, frame.size()) << to_hex(frame);
  }
}

TEST(LsExplain, AWriteIsShownInTheOrderWhoseLengthsAddUp) {
  EXPECT_EQ(part(request("01W1230200FF1234"), "address"), "1230");
  EXPECT_EQ(part(request("01W1230200FF1234"), "data 2"), "1234");
  EXPECT_EQ(part(request("01W2123000FF1234"), "address"), "1230") << "count first";
  EXPECT_EQ(part(request("01W2123000FF1234"), "count"), "2 (count first)");
  EXPECT_EQ(part(request("01W9123000FF"), "address"), "9123") << "neither adds up: address first";
  EXPECT_EQ(part(request("01W1000100FF"), "address"), "1000") << "both add up: address first";
}

TEST(LsExplain, SaysWhatIsWrong) {
  EXPECT_THAT(part(request("01R12309"), "count"), HasSubstr("not 1 to 8"));
  EXPECT_THAT(part(request("01R12300"), "count"), HasSubstr("not 1 to 8"));
  EXPECT_THAT(part(request("01R12G01"), "address"), HasSubstr("not hex"));
  EXPECT_THAT(part(request("01R123"), "address"), HasSubstr("cut short"));
  EXPECT_THAT(part(request("01X12301"), "command"), HasSubstr("neither R nor W"));
  EXPECT_THAT(part(request("01R1230112"), "surplus"), HasSubstr("nothing stands here"));
  EXPECT_THAT(part(request("01W9230200FF"), "data 1"), HasSubstr("words are missing"));
  EXPECT_THAT(part(to_bytes("\x06"
                            "01R12343\x04"),
                   "data"),
              HasSubstr("123 ! cut short"))
      << "the last two before EOT are the sum";
  EXPECT_EQ(part(to_bytes("\x06"
                          "01R12347D\x04\x06"
                          "01"),
                 "surplus"),
            "<06>01 ! nothing follows EOT");
  EXPECT_EQ(part(to_bytes("\x15"
                          "01R13224\x04"),
                 "error code"),
            "132 ! an error code has two characters");
}

TEST(LsExplain, SaysWhatIsWrongWithASum) {
  Bytes wrong = read_ack;
  wrong[wrong.size() - 2] = 'E';
  EXPECT_THAT(part(wrong, "SUM"), HasSubstr("7D is right"));
  const std::string body = "01R1234";  // its sum is 17D
  EXPECT_THAT(part(to_bytes('\x06' + body + "83\x04"), "SUM"), HasSubstr("takes the header in"));
  EXPECT_THAT(part(to_bytes('\x06' + body + "87\x04"), "SUM"),
              HasSubstr("takes header and tail in"));
  EXPECT_THAT(part(to_bytes('\x06' + body + "7d\x04"), "SUM"), HasSubstr("lower-case"));
}

TEST(LsExplain, TranslatesErrorCodes) {
  EXPECT_EQ(part(to_bytes("\x15"
                          "01RIA0D\x04"),
                 "error code"),
            "IA no such address");
  EXPECT_EQ(error_meaning("WM"), "not writable");
  EXPECT_EQ(error_meaning("12"), "");
}

TEST(LsExplain, AnyBytesAreReadWithoutHarm) {
  unsigned state = 7;
  for (int round = 0; round < 20'000; ++round) {
    Bytes frame;
    for (int i = 0; i < round % 24; ++i) {
      state = state * 1103515245u + 12345u;
      const std::string_view likely =
          "\x05\x06\x15\x04"
          "0129rRwWX0123F";
      frame.push_back((state >> 16) % 8 ? static_cast<Byte>(likely[(state >> 16) % likely.size()])
                                        : static_cast<Byte>(state >> 24));
    }
    std::size_t covered = 0;
    for (const harness::Field& field : explain(frame)) covered += field.size;
    EXPECT_EQ(covered, frame.size()) << to_hex(frame);
    (void)written_by(frame);
    if (const auto length = frame_length(frame)) {
      EXPECT_GT(*length, 0u);
      EXPECT_LE(*length, frame.size());
    }
  }
}

TEST(LsFrameLength, EndsAtEotOrAtTheNextHeader) {
  EXPECT_EQ(frame_length(read_ack), read_ack.size());
  EXPECT_EQ(frame_length(ByteView(read_ack).first(read_ack.size() - 1)), std::nullopt);
  EXPECT_EQ(frame_length(to_bytes("xyz\x04\x06")), 4u);
  EXPECT_EQ(frame_length(to_bytes("xy\x04z\x06")), 4u) << "EOT ends nothing that no header began";
  EXPECT_EQ(frame_length(to_bytes("xyz")), std::nullopt);
  EXPECT_EQ(frame_length(to_bytes("\x06"
                                  "01R\x15"
                                  "01R")),
            4u);
  EXPECT_EQ(frame_length({}), std::nullopt);
}

/// AA is printed in Cnet EN 8.2.2; each small letter adds 20 (hex).
TEST(LsFrameParts, DigitsOfARequestAreFree) {
  const auto plain = [](const std::string& body) {
    const Bytes bytes = in_plain_letters(to_bytes('\x05' + body + '\x04'));
    return std::string(bytes.begin() + 1, bytes.end() - 1);
  };
  EXPECT_EQ(plain("01R12301aa"), "01R12301AA");
  EXPECT_EQ(plain("01W0100100ff"
                  "d6"),
            "01W0100100FF96");
  EXPECT_EQ(plain("01W0100100ff"
                  "81"),
            "01W0100100ff81")
      << "a sum that is wrong stays so";
  EXPECT_EQ(plain("01r12301CA"), "01r12301CA") << "commands are capitals";
}

TEST(LsFrameParts, WhatIsMissingIsSaid) {
  EXPECT_EQ(explain(to_bytes("\x05"
                             "01R1230"
                             "1"))
                .back()
                .problem,
            "no EOT follows, with the sum before it");
}

}  // namespace
}  // namespace fieldproof::ls_bus_suite
