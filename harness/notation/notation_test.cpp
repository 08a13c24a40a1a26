#include "harness/notation/notation.hpp"

#include <gmock/gmock.h>

namespace fieldproof::notation {
namespace {

using testing::HasSubstr;

std::string reprinted(std::string_view text) {
  const Result<Notation> notation = parse_notation(text);
  return notation ? print(*notation) : notation.error().message;
}

TEST(Notation, PrintsWhatItParsed) {
  for (const char* text :
       {"[ENQ st 'rSS' '02' name(%MW020) EOT BCC]", "[ACK st 'rSS' '01' '02' x:4 ETX BCC]",
        "'noise' [ENQ st+1 'X09' EOT]", "[ENQ ~1.6c 0D FF seq(60) '1234'*60 EOT BCC!]",
        "[?? {id:4} {id} ?? SUM CRC LRC]", "[STX (as_sent:'ss'|upper:'SS' 0D) CR LF]",
        "~20ms [ENQ ~1s EOT]", "[STX 3456*1 3456*123 ETX]"})
    EXPECT_EQ(reprinted(text), text);
}

TEST(Notation, SpaceIsFreeBetweenWords) {
  EXPECT_EQ(reprinted(" [ENQ   st\tEOT ] "), "[ENQ st EOT]");
}

TEST(Notation, ErrorsNameTheColumn) {
  EXPECT_THAT(reprinted("[ENQ ENX EOT]"), HasSubstr("column 6: unknown word 'ENX'"));
  EXPECT_THAT(reprinted("[ENQ 'abc EOT]"), HasSubstr("column 6: the quote is never closed"));
  EXPECT_THAT(reprinted("[ENQ EOT"), HasSubstr("'[' is never closed"));
  EXPECT_THAT(reprinted("ENQ ]"), HasSubstr("column 5: ']' without '['"));
  EXPECT_THAT(reprinted("[ENQ [EOT]"), HasSubstr("'[' inside '['"));
  EXPECT_THAT(reprinted("ENQ BCC"), HasSubstr("a check stands inside"));
  EXPECT_THAT(reprinted("[ENQ ~20 EOT]"), HasSubstr("a pause is ~20ms"));
  EXPECT_THAT(reprinted("[ENQ x: EOT]"), HasSubstr("hex digits are written x:4"));
  EXPECT_THAT(reprinted("[ENQ {id:0} EOT]"), HasSubstr("a capture is {id:4}"));
  EXPECT_THAT(reprinted("[ENQ seq(0) EOT]"), HasSubstr("seq(60)"));
  EXPECT_THAT(reprinted("[ENQ '1'*0 EOT]"), HasSubstr("a repetition is *n"));
  EXPECT_THAT(reprinted("[ENQ name(%MW0 EOT]"), HasSubstr("name(...)"));
  EXPECT_THAT(reprinted("[(a:'x'"), HasSubstr("'(' is never closed"));
  EXPECT_THAT(reprinted("''"), HasSubstr("empty quotes"));
  EXPECT_THAT(reprinted("?"), HasSubstr("any byte is written ??"));
}

TEST(Notation, AnyTextIsParsedOrRefusedButNeverCrashes) {
  const std::string alphabet = "[]'~?{}()|*:x1s ENQBCC!+";
  unsigned state = 1;
  for (int round = 0; round < 20'000; ++round) {
    std::string text;
    for (int i = 0; i < 12; ++i) {
      state = state * 1103515245u + 12345u;
      text += alphabet[(state >> 16) % alphabet.size()];
    }
    if (const Result<Notation> notation = parse_notation(text)) {
      EXPECT_EQ(reprinted(print(*notation)), print(*notation)) << text;
    }
  }
}

/// Found by ./fuzz.sh: it was printed as st+-1.
TEST(Notation, AnotherStationHasANumber) {
  EXPECT_FALSE(parse_notation("[st+ACKC]"));
  EXPECT_FALSE(parse_notation("[st+]"));
  EXPECT_TRUE(parse_notation("[st+0]"));
}

TEST(Notation, APauseEnds) {
  for (const char* text : {"~infms", "~nanms", "~-1ms", "~1e300c", "~3601s"})
    EXPECT_FALSE(parse_notation(text)) << text;
  EXPECT_TRUE(parse_notation("~3600s"));
}

/// Each level was one of the stack.
TEST(Notation, AlternativesDoNotNestForEver) {
  std::string open, close;
  for (int i = 0; i < 8; ++i) open += "(a:", close += ")";
  EXPECT_TRUE(parse_notation("[" + open + "00" + close + "]"));
  EXPECT_EQ(parse_notation("[(a:" + open + "00" + close + ")]").error().message,
            "cannot read the notation at column 26: alternatives stand at most 8 deep");
  for (int i = 0; i < 100'000; ++i) open += "(a:";
  EXPECT_FALSE(parse_notation(open));
}

TEST(PrintBytes, ShowsControlsTextAndTheRestInHex) {
  EXPECT_EQ(print_bytes(to_bytes("\x05"
                                 "01rSS'"
                                 "\x04"
                                 "A4\xFF")),
            "ENQ '01rSS' 27 EOT 'A4' FF");
  EXPECT_EQ(print_bytes(Bytes{}), "");
  // Modbus RTU: names of control characters would mislead where most bytes are numbers.
  EXPECT_EQ(print_bytes(*from_hex("01 03 00 63 00 01 74 14")), "01 03 00 63 00 01 74 14");
}

TEST(Pause, CharactersScaleWithTheLine) {
  EXPECT_EQ((Pause{1.5, true}.at(1ms)), 1500us);
  EXPECT_EQ((Pause{20, false}.at(1ms)), 20ms);
}

}  // namespace
}  // namespace fieldproof::notation
