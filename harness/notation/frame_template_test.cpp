#include "harness/notation/frame_template.hpp"

#include <gmock/gmock.h>

#include <array>

#include "suites/checks/checks.hpp"

namespace fieldproof::notation {
namespace {

const std::array<Check, 3> known{checks::bcc, checks::length, checks::sum};
Bytes two_digits(std::size_t characters) { return to_bytes(hex_number(characters, 2)); }
const Fields station_1{to_bytes("01"), to_bytes("02"), known, two_digits};

std::vector<FrameTemplate> templates(std::string_view text) {
  const Result<Notation> notation = parse_notation(text);
  EXPECT_TRUE(notation) << (notation ? "" : notation.error().message);
  Result<std::vector<FrameTemplate>> made = make_templates(*notation, station_1);
  EXPECT_TRUE(made);
  return *made;
}

std::string hex(std::string_view text) { return to_hex_with_holes(templates(text).at(0)); }

// Cnet EN 7.1.5 (1)(e): the manual's own bytes.
TEST(FrameTemplate, IsTheManualsFrame) {
  EXPECT_EQ(hex("[ENQ st 'rSS' '02' name(%MW020) name(%PW001) EOT BCC]"),
            "05 30 31 72 53 53 30 32 30 36 25 4D 57 30 32 30 30 36 25 50 57 30 30 31 04 36 38");
}

TEST(FrameTemplate, BccVanishesForUpperCaseAndStaysWhenWrong) {
  EXPECT_EQ(hex("[ENQ st 'RSS' EOT BCC]"), "05 30 31 52 53 53 04");
  EXPECT_EQ(templates("[ENQ st 'RSS' EOT BCC!]")[0].bytes.size(), 9u);
  EXPECT_NE(hex("[ENQ st 'rSS' EOT BCC!]"), hex("[ENQ st 'rSS' EOT BCC]"));
}

TEST(FrameTemplate, ACheckOfWhatFollowsIsKnownAtTheEndOfItsBracket) {
  EXPECT_EQ(hex("[00 01 00 00 LEN 01 03 00 63 00 01] 'x'"),
            "00 01 00 00 00 06 01 03 00 63 00 01 78");
  EXPECT_EQ(hex("[00 01 00 00 LEN! 01 03]"), "00 01 00 00 00 03 01 03");
  const FrameTemplate frame = templates("[00 01 00 00 LEN 01 03 02 ?? ??]")[0];
  Captures captures;
  EXPECT_EQ(first_mismatch(frame, *from_hex("00 01 00 00 00 05 01 03 02 12 34"), captures),
            std::nullopt);
  EXPECT_EQ(first_mismatch(frame, *from_hex("00 01 00 00 00 06 01 03 02 12 34"), captures), 5u);
}

TEST(FrameTemplate, AnUnknownCheckNamesThoseOfTheProtocol) {
  const auto made = make_templates(*parse_notation("[ENQ 'a' BCD]"), station_1);
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().message,
            "unknown word 'BCD': it is no control character, and the checks of this protocol are "
            "BCC, LEN, SUM; did you mean 'BCC'?");
}

TEST(FrameTemplate, ACheckCoversItsOwnBracketAlone) {
  EXPECT_EQ(hex("'noise' [ENQ st 'rSS' EOT BCC]").substr(15), hex("[ENQ st 'rSS' EOT BCC]"));
}

TEST(FrameTemplate, MovingFieldsAndRepetition) {
  EXPECT_EQ(hex("st+1 '12'*2 seq(2)"), to_hex(to_bytes("02"
                                                       "1212"
                                                       "00010002")));
  EXPECT_EQ(hex("name(%MW020)"), to_hex(to_bytes("06%MW020")));
}

TEST(FrameTemplate, HolesMatchWhatTheyAllow) {
  const FrameTemplate frame = templates("[ACK st 'rSS' x:2 ?? ETX BCC]")[0];
  Captures captures;
  const auto reply = [](const std::string& data) {
    Bytes bytes = to_bytes(
        "\x06"
        "01rSS" +
        data + "\x03");
    const Bytes check = checks::bcc.over(bytes);
    bytes.insert(bytes.end(), check.begin(), check.end());
    return bytes;
  };
  EXPECT_EQ(first_mismatch(frame, reply("A9z"), captures), std::nullopt);
  EXPECT_EQ(first_mismatch(frame, reply("G9z"), captures), 6u);
  EXPECT_EQ(first_mismatch(frame, reply("a9z"), captures), 6u) << "replies use upper-case hex";
  Bytes wrong = reply("A9z");
  wrong.back() ^= 1;
  EXPECT_EQ(first_mismatch(frame, wrong, captures), wrong.size() - 1);
}

TEST(FrameTemplate, LengthIsPartOfTheMatch) {
  const FrameTemplate frame = templates("'abc'")[0];
  Captures captures;
  EXPECT_EQ(first_mismatch(frame, to_bytes("ab"), captures), 2u);
  EXPECT_EQ(first_mismatch(frame, to_bytes("abcd"), captures), 3u);
  EXPECT_EQ(first_mismatch(frame, to_bytes("abx"), captures), 2u);
}

TEST(FrameTemplate, CapturesAreReused) {
  Captures captures;
  EXPECT_EQ(first_mismatch(templates("'a' {id:4}")[0], to_bytes("a1234"), captures), std::nullopt);
  EXPECT_EQ(captures.at("id"), "1234");
  EXPECT_EQ(first_mismatch(templates("{id}")[0], to_bytes("1234"), captures), std::nullopt);
  EXPECT_EQ(first_mismatch(templates("{id}")[0], to_bytes("1235"), captures), 3u);
  const Result<Bytes> sent = render(templates("[ENQ {id} EOT SUM]")[0], captures);
  ASSERT_TRUE(sent);
  EXPECT_EQ(to_text(*sent),
            "\x05"
            "1234"
            "\x04"
            "CE");
}

TEST(FrameTemplate, OpenPlacesCannotBeSent) { EXPECT_FALSE(render(templates("?? 'a'")[0], {})); }

TEST(FrameTemplate, AlternativesGiveOneTemplateEachThePreferredFirst) {
  const std::vector<FrameTemplate> frames = templates("[ACK (as_sent:'ss'|upper:'SS') ETX]");
  ASSERT_EQ(frames.size(), 2u);
  EXPECT_EQ(to_text(frames[0].bytes), "\x06ss\x03");
  EXPECT_EQ(to_text(frames[1].bytes), "\x06SS\x03");
  EXPECT_EQ(frames[1].readings.at("as_sent"), "upper");
}

TEST(FrameTemplate, PausesKnowTheirPlace) {
  const FrameTemplate frame = templates("[ENQ ~20ms '01' ~1.6c EOT]")[0];
  ASSERT_EQ(frame.gaps.size(), 2u);
  EXPECT_EQ(frame.gaps[0].before, 1u);
  EXPECT_EQ(frame.gaps[1].before, 3u);
}

}  // namespace
}  // namespace fieldproof::notation
