#include "src/user_frames/variable.hpp"

#include <gtest/gtest.h>

namespace fieldproof::user_frames {
namespace {

std::string convert(Convert how, std::string_view hex) {
  const std::optional<Bytes> bytes = converted(how, *from_hex(hex));
  return bytes ? to_hex(*bytes) : "none";
}
std::string swap(std::size_t group, std::string_view hex) {
  return to_hex(swapped(group, *from_hex(hex)));
}

TEST(UserFrameVariable, HexToAsciiDoubles) {
  EXPECT_EQ(convert(Convert::hex_to_ascii, "12 34 56 78"),
            "31 32 33 34 35 36 37 38");  // Cnet EN 6.2.5 3) C)
  EXPECT_EQ(convert(Convert::hex_to_ascii, "AB"), "41 42");
}

TEST(UserFrameVariable, AsciiToHexHalves) {
  EXPECT_EQ(convert(Convert::ascii_to_hex, "34 35 36 37"), "45 67");
  EXPECT_EQ(convert(Convert::ascii_to_hex, "61 46"), "AF");
  EXPECT_EQ(convert(Convert::ascii_to_hex, "34 35 36"), "none");
  EXPECT_EQ(convert(Convert::ascii_to_hex, "34 47"), "none");
}

/// Cnet EN 6.2.5 4) B).
TEST(UserFrameVariable, SwapTurnsGroupsRound) {
  EXPECT_EQ(swap(2, "1234567811223344"), "34 12 78 56 22 11 44 33");
  EXPECT_EQ(swap(4, "1234567811223344"), "78 56 34 12 44 33 22 11");
  EXPECT_EQ(swap(8, "1234567811223344"), "44 33 22 11 78 56 34 12");
  EXPECT_EQ(swap(1, "1234"), "12 34");
}

TEST(UserFrameVariable, AnIncompleteGroupStays) {
  EXPECT_EQ(swap(2, "123456"), "34 12 56");
  EXPECT_EQ(swap(4, "1234"), "12 34");
  EXPECT_EQ(swap(8, ""), "");
}

class Memory : public testing::Test {
 protected:
  plc::DeviceAddress at(std::string_view name) const {
    return plc::parse_address(memory.model(), name).address;
  }
  std::string read(std::string_view name, std::size_t count) const {
    return to_hex(read_bytes(memory, at(name), count));
  }
  void write(std::string_view name, std::string_view hex) {
    write_bytes(memory, at(name), *from_hex(hex));
  }

  plc::PlcMemory memory{*plc::find_plc_model("xbc-h")};
};

TEST_F(Memory, WordsAreReadHighByteFirst) {
  ASSERT_TRUE(plc::set_by_name(memory, "%MW100", "123456789ABC"));
  EXPECT_EQ(read("%MW100", 6), "12 34 56 78 9A BC");
  EXPECT_EQ(read("%MW100", 3), "12 34 56");
  EXPECT_EQ(read("%MB200", 6), "34 12 78 56 BC 9A");
  EXPECT_EQ(read("%MD50", 4), "56 78 12 34");  // the second word is the high one
}

TEST_F(Memory, WhatIsWrittenIsReadBack) {
  for (const char* name : {"%MW100", "%MB200", "%MD50", "%ML25"}) {
    write(name, "0102030405060708");
    EXPECT_EQ(read(name, 8), "01 02 03 04 05 06 07 08") << name;
  }
}

TEST_F(Memory, AnElementThatIsNotFilledKeepsItsLowBytes) {
  ASSERT_TRUE(plc::set_by_name(memory, "%MW100", "AAAABBBBCCCC"));
  write("%MW100", "112233");
  EXPECT_EQ(read("%MW100", 6), "11 22 33 BB CC CC");
}

TEST_F(Memory, BytesMustFitIntoTheArea) {
  const std::uint32_t last = memory.model().area('M')->last_word();
  EXPECT_TRUE(fits_bytes(memory.model(), at("%MW" + std::to_string(last)), 2));
  EXPECT_FALSE(fits_bytes(memory.model(), at("%MW" + std::to_string(last)), 3));
  EXPECT_TRUE(fits_bytes(memory.model(), at("%MW" + std::to_string(last)), 0));
}

}  // namespace
}  // namespace fieldproof::user_frames
