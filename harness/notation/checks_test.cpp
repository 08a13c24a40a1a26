#include "harness/notation/checks.hpp"

#include <gtest/gtest.h>

namespace fieldproof::notation {
namespace {

// Cnet EN 7.1.5 (1)(b): H05+H32+...+H04 = H03A4, therefore the BCC is A4.
TEST(Checks, BccIsTheManualsWorkedSum) {
  EXPECT_EQ(compute_check(CheckKind::bcc,
                          *from_hex("05 32 30 72 53 53 30 31 30 36 25 4D 57 31 30 30 04")),
            to_bytes("A4"));
}

// Cnet EN 11.2.4: the frame monitor shows ENQ 01rSS0104%MW0 EOT 40.
TEST(Checks, BccIsTheCapturedOne) {
  EXPECT_EQ(compute_check(CheckKind::bcc, to_bytes("\x05"
                                                   "01rSS0104%MW0"
                                                   "\x04")),
            to_bytes("40"));
}

TEST(Checks, SumLeavesTheHeaderOut) {
  EXPECT_EQ(compute_check(CheckKind::sum, to_bytes("\x05"
                                                   "01R30001")),
            to_bytes("A7"));
}

// "123456789" is the check string of the CRC catalogues: CRC-16/MODBUS is 4B37.
TEST(Checks, CrcIsLowByteFirst) {
  EXPECT_EQ(compute_check(CheckKind::crc, to_bytes("123456789")), (Bytes{0x37, 0x4B}));
}

TEST(Checks, LrcIsTheTwosComplementOfThePairs) {
  // 01 + 03 + 00 + 00 + 00 + 0A = 0E; 100 - 0E = F2
  EXPECT_EQ(compute_check(CheckKind::lrc, to_bytes(":01030000000A")), to_bytes("F2"));
}

TEST(Checks, AWrongCheckDiffersFromTheRightOne) {
  const Bytes frame = to_bytes(
      "\x05"
      "01rSS0104%MW0"
      "\x04");
  for (CheckKind kind : {CheckKind::bcc, CheckKind::sum, CheckKind::crc, CheckKind::lrc})
    EXPECT_NE(compute_check(kind, frame), compute_wrong_check(kind, frame)) << to_string(kind);
}

}  // namespace
}  // namespace fieldproof::notation
