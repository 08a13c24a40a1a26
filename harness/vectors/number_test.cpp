#include "harness/vectors/number.hpp"

#include <gtest/gtest.h>

namespace fieldproof::vectors {
namespace {

TEST(Number, DigitsHaveTheLowWordFirst) {
  EXPECT_EQ(read_number("dec(1500)")->digits(), "05DC");
  EXPECT_EQ(read_number("dec(-1)")->digits(), "FFFF");
  EXPECT_EQ(read_number("dec32(100000)")->digits(), "86A00001");
  EXPECT_EQ(read_number("dec32(-400)")->digits(), "FE70FFFF");
  EXPECT_EQ(read_number("dec64(131072)")->digits(), "0000000200000000");
  EXPECT_EQ(read_number("float(0.5)")->digits(), "00003F00");
  EXPECT_EQ(read_number("dec(40000)")->digits(), "9C40");
}

TEST(Number, WhatIsCheckedMayLieBetweenTwo) {
  const auto range = read_number("dec32(-10..641)");
  ASSERT_TRUE(range);
  EXPECT_TRUE(range->is_range());
  EXPECT_TRUE(range->holds("FFF6FFFF"));
  EXPECT_FALSE(range->holds("FFF5FFFF"));
  EXPECT_TRUE(range->holds("02810000"));
  EXPECT_FALSE(range->holds("02820000"));
  EXPECT_EQ(range->text(), "-10 to 641");
  EXPECT_EQ(range->text_of("FE70FFFF"), "-400");
  EXPECT_TRUE(read_number("float(0.02..0.03)")->holds("7EFA3CBF"));  // 0.02337563
  EXPECT_TRUE(read_number("float(0.1)")->holds(read_number("float(0.1)")->digits()));
  EXPECT_TRUE(read_number("dec(40000)")->holds("9C40"));
  EXPECT_FALSE(read_number("dec(40000)")->holds("9C41"));
}

TEST(Number, WhatIsNone) {
  for (const char* wrong :
       {"", "12", "dec", "dec()", "dec(x)", "dec(1", "dec(1.5)", "dec(65536)", "dec(-32769)",
        "dec32(2..1)", "dec32(1..)", "float(a)", "seq(3)", "dec64(1e300)", "word(1)"})
    EXPECT_FALSE(read_number(wrong)) << wrong;
}

}  // namespace
}  // namespace fieldproof::vectors
