#include "src/base/bytes.hpp"

#include <gtest/gtest.h>

namespace fieldproof {
namespace {

TEST(Bytes, HexIsUpperCaseAndSpaced) {
  EXPECT_EQ(to_hex(Bytes{0x05, 0x30, 0xFF}), "05 30 FF");
  EXPECT_EQ(to_hex(Bytes{}), "");
}

TEST(Bytes, HexIsReadWithAndWithoutSpaces) {
  EXPECT_EQ(from_hex("05 30 ff"), (Bytes{0x05, 0x30, 0xFF}));
  EXPECT_EQ(from_hex("0530FF"), (Bytes{0x05, 0x30, 0xFF}));
}

TEST(Bytes, HexWithHalfAByteOrAForeignDigitIsRefused) {
  EXPECT_FALSE(from_hex("05 3"));
  EXPECT_FALSE(from_hex("0 5"));
  EXPECT_FALSE(from_hex("0G"));
}

TEST(Bytes, EveryByteSurvivesTheRoundTrip) {
  Bytes all;
  for (int i = 0; i < 256; ++i) all.push_back(static_cast<Byte>(i));
  EXPECT_EQ(from_hex(to_hex(all)), all);
  EXPECT_EQ(to_bytes(to_text(all)), all);
}

TEST(Bytes, NumbersHaveTheDigitsAskedFor) {
  EXPECT_EQ(hex_number(0x3A4, 2), "A4");
  EXPECT_EQ(hex_number(1, 4), "0001");
}

}  // namespace
}  // namespace fieldproof
