#include "harness/notation/pdu.hpp"

#include <gmock/gmock.h>

#include "harness/notation/notation.hpp"

namespace fieldproof::notation {
namespace {

using testing::HasSubstr;

constexpr Dressing binary{"[${station} ${body} CRC${wrong}]", false};
constexpr Dressing digits{"[':' ${station} ${body} LRC${wrong} CR LF]", true};
constexpr Dressing numbered{"[${transaction} 00 00 ${station} ${body}]", false};

Result<std::string> no_transaction() { return fail("no transaction here"); }

std::string dressed(std::string_view text, const Dressing& dressing) {
  const Result<std::string> result = dress(text, dressing, no_transaction);
  if (!result) return "error: " + result.error().message;
  EXPECT_TRUE(parse_notation(*result)) << *result;
  return *result;
}

TEST(Pdu, IsFramedByEachInItsWay) {
  EXPECT_EQ(dressed("pdu(03 00 63 00 01)", binary), "[st 03 00 63 00 01 CRC]");
  EXPECT_EQ(dressed("pdu(03 00 63 00 01)", digits), "[':' st '0300630001' LRC CR LF]");
}

TEST(Pdu, ASendMayHaveSeveralAndMore) {
  EXPECT_EQ(dressed("'pdu(' ~20ms pdu(07) [st 01] pdu(08)", binary),
            "'pdu(' ~20ms [st 07 CRC] [st 01] [st 08 CRC]");
}

TEST(Pdu, AnotherStationAndAWrongCheck) {
  EXPECT_EQ(dressed("pdu@02(07)", binary), "[02 07 CRC]");
  EXPECT_EQ(dressed("pdu@02!(07)", digits), "[':' '02' '07' LRC! CR LF]");
  EXPECT_EQ(dressed("pdu@st+1!(07)", digits), "[':' st+1 '07' LRC! CR LF]");
  EXPECT_EQ(dressed("pdu!(07)", binary), "[st 07 CRC!]");
}

TEST(Pdu, TransactionsAreAskedForInOrder) {
  int number = 0;
  const auto next = [&]() -> Result<std::string> { return "00 " + hex_number(++number, 2); };
  EXPECT_EQ(*dress("pdu(07) pdu@09(08)", numbered, next),
            "[00 01 00 00 st 07] [00 02 00 00 09 08]");
  EXPECT_EQ(dressed("pdu(07)", numbered), "error: no transaction here");
}

TEST(Pdu, RepetitionsAndTexts) {
  EXPECT_EQ(dressed("pdu(10 5634*123 AA*2 'V4')", binary), "[st 10 5634*123 AA*2 'V4' CRC]");
  EXPECT_EQ(dressed("pdu(10 5634*123 AA*2 'V4')", digits),
            "[':' st '10' '5634'*123 'AA'*2 '5634' LRC CR LF]");
  EXPECT_EQ(dressed("pdu(10 seq(2))", binary), "[st 10 00 01 00 02 CRC]");
  EXPECT_EQ(dressed("pdu(10 seq(2)*3)", binary), "[st 10 00010002*3 CRC]");
  EXPECT_EQ(dressed("pdu(10 seq(2))", digits), "[':' st '10' seq(2) LRC CR LF]");
}

TEST(Pdu, OpenPlaces) {
  EXPECT_EQ(dressed("pdu(03 ?? x:4 ??*3)", binary), "[st 03 ?? ??*2 ??*3 CRC]");
  EXPECT_EQ(dressed("pdu(03 ?? x:4 ??*3)", digits), "[':' st '03' x:2 x:4 x:6 LRC CR LF]");
  EXPECT_EQ(dressed("pdu(03 {a:2} {a})", binary), "[st 03 {a:2} {a} CRC]");
  EXPECT_EQ(dressed("pdu(03 {a:2} {a})", digits), "[':' st '03' {a:4} {a} LRC CR LF]");
  EXPECT_EQ(dressed("pdu(03 (a: 01 02 | b: ?? ))", binary), "[st 03 (a:01 02|b:?\?) CRC]");
  EXPECT_EQ(dressed("pdu(03 (a: 01 02 | b: ?? ))", digits),
            "[':' st '03' (a:'0102'|b:x:2) LRC CR LF]");
}

TEST(Pdu, ErrorsSayWhatToWrite) {
  EXPECT_THAT(dressed("pdu(03", binary), HasSubstr("column 4 is never closed; add ')'"));
  EXPECT_THAT(dressed("pdu@(03)", binary), HasSubstr("pdu@02(03 00)"));
  EXPECT_THAT(dressed("pdu@02", binary), HasSubstr("pdu@02(03 00)"));
  EXPECT_THAT(dressed("pdu(03 0)", binary), HasSubstr("unknown word '0'"));
  EXPECT_THAT(dressed("pdu(03 CRC)", binary), HasSubstr("'[ ]'"));
  EXPECT_THAT(dressed("pdu(name(M))", digits), HasSubstr("'name(M)' cannot stand in pdu(...)"));
  EXPECT_EQ(dressed("pdu(02 name(M))", binary), "[st 02 name(M) CRC]");
  EXPECT_THAT(dressed("pdu(x:3)", binary), HasSubstr("half a byte"));
  EXPECT_THAT(dressed("pdu!(03)", numbered), HasSubstr("no check that could be wrong"));
}

TEST(HasPdu, OutsideQuotesAndAsAWordOfItsOwn) {
  EXPECT_TRUE(has_pdu("~20ms pdu(03)"));
  EXPECT_TRUE(has_pdu("pdu@02!(03)"));
  EXPECT_FALSE(has_pdu("'pdu(03)' [st pdus xpdu]"));
}

}  // namespace
}  // namespace fieldproof::notation
