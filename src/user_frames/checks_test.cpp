#include "src/user_frames/checks.hpp"

#include <gtest/gtest.h>

#include <set>

namespace fieldproof::user_frames {
namespace {

/// With the start value of the method.
std::string check(std::string_view method, ByteView covered, CheckOptions options = {}) {
  const CheckMethodFacts* facts = find_check_method(method);
  if (!facts) return "no such method";
  if (options.start == 0) options.start = facts->start;
  return to_hex(compute_check(facts->method, options, covered));
}

std::string from_zero(CheckMethod method, ByteView covered, bool low_first = true) {
  return to_hex(compute_check(method, {.low_first = low_first}, covered));
}

const Bytes nine = to_bytes("123456789");  // the sum of its bytes is 1DD, the exclusive or 31

TEST(UserFrameChecks, ThereAreTheTwelveOfTheManual) {
  std::set<std::string_view> names;
  for (const CheckMethodFacts& facts : check_methods()) names.insert(facts.name);
  EXPECT_EQ(names.size(), 12u);
  EXPECT_EQ(find_check_method("byte_summ"), nullptr);
}

TEST(UserFrameChecks, SumsStartAtZero) {
  EXPECT_EQ(check("byte_sum", nine), "DD");
  EXPECT_EQ(check("7bit_sum", nine), "5D");
  EXPECT_EQ(check("byte_sum_2s_comp", nine), "23");
  EXPECT_EQ(check("byte_sum_1s_comp", nine), "22");
}

TEST(UserFrameChecks, ExclusiveOrStartsAtAllOnes) {
  EXPECT_EQ(check("byte_xor", nine), "CE");
  EXPECT_EQ(check("7bit_xor", nine), "4E");
  EXPECT_EQ(from_zero(CheckMethod::byte_xor, nine), "31");
}

TEST(UserFrameChecks, ASumCanStartAtAllOnes) {
  EXPECT_EQ(check("byte_sum", nine, {.start = 0xFF}), "DC");
}

/// The published check values of CRC-16/MODBUS and CRC-16/ARC, low byte first.
TEST(UserFrameChecks, Crc16HasThePublishedValues) {
  EXPECT_EQ(check("crc_16", nine), "37 4B");
  EXPECT_EQ(check("crc_16", nine, {.low_first = false}), "4B 37");
  EXPECT_EQ(from_zero(CheckMethod::crc_16, nine), "3D BB");
}

/// 3231 + 3433 + 3635 + 3837 + 0039 = D509; high byte first 3132 + 3334 + 3536 + 3738 + 3900 =
/// 109D4.
TEST(UserFrameChecks, WordSumAddsWordsAndALeftOverByte) {
  EXPECT_EQ(check("word_sum", nine), "09 D5");
  EXPECT_EQ(check("word_sum", nine, {.low_first = false}), "09 D4");
  EXPECT_EQ(check("word_sum", Bytes{0xFF, 0xFF, 0x02, 0x00}), "01 00");
}

TEST(UserFrameChecks, SevenBitSum1IsNeverAControlCharacter) {
  EXPECT_EQ(check("7bit_sum_1", Bytes{0x1F}), "3F");
  EXPECT_EQ(check("7bit_sum_1", Bytes{0x20}), "20");
  EXPECT_EQ(check("7bit_sum_1", Bytes{0x80, 0x05}), "25");
}

/// The two examples of the 5370-CVIM manual.
TEST(UserFrameChecks, DleAbIsTheBccOfDf1) {
  EXPECT_EQ(check("dle_ab", Bytes{0x08, 0x09, 0x06, 0x00, 0x02, 0x04, 0x03}), "E0");
  EXPECT_EQ(check("dle_ab", Bytes{0x08, 0x09, 0x06, 0x00, 0x10, 0x10, 0x04, 0x03}), "D2");
  EXPECT_EQ(check("dle_ab", Bytes{0x10, 0x10, 0x10, 0x10, 0x10}), "D0");  // two doubled, one alone
  EXPECT_EQ(check("dle_ab", Bytes{0x41, 0x10, 0x10}), "AF");
}

/// BCC = (exclusive or of the data block) xor 13.
TEST(UserFrameChecks, DleSiemensIsTheBccOf3964R) {
  EXPECT_EQ(check("dle_siemens", Bytes{0x41, 0x42, 0x10, 0x03}), "10");
}

TEST(UserFrameChecks, AsciiConversionDoublesTheLength) {
  EXPECT_EQ(check("byte_sum", nine, {.ascii = true}), "44 44");
  EXPECT_EQ(check("crc_16", nine, {.ascii = true}), "33 37 34 42");
  EXPECT_EQ(check_size(CheckMethod::crc_16, true), 4u);
  EXPECT_EQ(check_size(CheckMethod::byte_xor, false), 1u);
}

/// Cnet EN 7.1.5: 05 32 30 72 53 53 30 31 30 36 25 4D 57 31 30 30 04 sums up to 3A4.
TEST(UserFrameChecks, ByteSumIsTheBccOfXgtCnet) {
  EXPECT_EQ(check("byte_sum", *from_hex("05 32 30 72 53 53 30 31 30 36 25 4D 57 31 30 30 04"),
                  {.ascii = true}),
            "41 34");
}

TEST(UserFrameChecks, LgisCrcIsNotMadeUp) {
  EXPECT_EQ(find_check_method("lgis_crc")->bytes, 0u);
  EXPECT_THROW((void)compute_check(CheckMethod::lgis_crc, {}, nine), std::logic_error);
}

}  // namespace
}  // namespace fieldproof::user_frames
