#include "suites/checks/checks.hpp"

#include <gtest/gtest.h>

namespace fieldproof::checks {
namespace {

// Cnet EN 7.1.5 (1)(b): H05+H32+...+H04 = H03A4, therefore the BCC is A4.
TEST(Checks, BccIsTheManualsWorkedSum) {
  EXPECT_EQ(bcc.over(*from_hex("05 32 30 72 53 53 30 31 30 36 25 4D 57 31 30 30 04")),
            to_bytes("A4"));
}

// Cnet EN 11.2.4: the frame monitor shows ENQ 01rSS0104%MW0 EOT 40.
TEST(Checks, BccIsTheCapturedOne) {
  EXPECT_EQ(bcc.over(to_bytes("\x05"
                              "01rSS0104%MW0"
                              "\x04")),
            to_bytes("40"));
}

TEST(Checks, SumLeavesTheHeaderOut) {
  EXPECT_EQ(sum.over(to_bytes("\x05"
                              "01R30001")),
            to_bytes("A7"));
}

// "123456789" is the check string of the CRC catalogues: CRC-16/MODBUS is 4B37.
TEST(Checks, CrcIsLowByteFirst) { EXPECT_EQ(crc.over(to_bytes("123456789")), (Bytes{0x37, 0x4B})); }

TEST(Checks, LrcIsTheTwosComplementOfThePairs) {
  // 01 + 03 + 00 + 00 + 00 + 0A = 0E; 100 - 0E = F2
  EXPECT_EQ(lrc.over(to_bytes(":01030000000A")), to_bytes("F2"));
}

// FEnet EN 5.3.5: the length is that of the bytes behind it, high byte first.
TEST(Checks, LengthCountsWhatFollows) {
  EXPECT_EQ(length.over(Bytes(6)), (Bytes{0, 6}));
  EXPECT_EQ(length.over(Bytes(0x104)), (Bytes{1, 4}));
  EXPECT_TRUE(length.behind);
}

// FEnet EN 5.2.6, table 5-8: 3F, and 16 bytes behind the header.
TEST(Checks, TheFenetHeaderCountsItsBodyAndSumsWhatPrecedes) {
  const Bytes header = *from_hex("4C 53 49 53 2D 58 47 54 00 00 00 00 A0 33 00 01 10 00 00");
  EXPECT_EQ(fenet_sum.over(header), Bytes{0x3F});
  EXPECT_EQ(fenet_length.over(Bytes(2 + 16)), (Bytes{0x10, 0}));
  EXPECT_EQ(fenet_length.over(Bytes(2 + 0x104)), (Bytes{4, 1}));
  EXPECT_EQ(fenet_length.over(Bytes(1)), (Bytes{0, 0}));
}

TEST(Checks, OnlyFramesOfLowerCaseCommandsHaveABcc) {
  EXPECT_TRUE(
      bcc.absent(to_bytes("\x05"
                          "01RSS")));
  EXPECT_FALSE(
      bcc.absent(to_bytes("\x05"
                          "01rSS")));
  EXPECT_FALSE(
      bcc.absent(to_bytes("\x05"
                          "01")));
}

TEST(Checks, AWrongCheckDiffersFromTheRightOne) {
  const Bytes frame = to_bytes(
      "\x05"
      "01rSS0104%MW0"
      "\x04");
  for (const notation::Check& check : {bcc, sum, crc, lrc, length, fenet_length, fenet_sum})
    EXPECT_NE(check.over(frame), check.wrong_over(frame)) << check.name;
}

}  // namespace
}  // namespace fieldproof::checks
