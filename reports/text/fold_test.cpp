#include "reports/text/fold.hpp"

#include <gtest/gtest.h>

namespace fieldproof::text {
namespace {

TEST(Fold, LeavesWhatFits) {
  EXPECT_EQ(fold("", 10), "");
  EXPECT_EQ(fold("\n\na\n", 10), "\n\na\n");
  EXPECT_EQ(fold("0123456789\nab", 10), "0123456789\nab");
  EXPECT_EQ(fold(std::string(500, 'x') + " y", 0), std::string(500, 'x') + " y") << "no terminal";
}

TEST(Fold, BreaksBetweenWordsBelowTheText) {
  EXPECT_EQ(fold("one two three\n", 8), "one two\nthree\n");
  EXPECT_EQ(fold("  one two three", 8), "  one\n  two\n  three");
  EXPECT_EQ(fold("  clause    one of the clauses of a manual\n", 30),
            "  clause    one of the clauses\n            of a manual\n");
}

TEST(Fold, ALabelThatLeavesNoRoomIsNoLabel) {
  EXPECT_EQ(fold("a rather long label  and a text", 20), "a rather long label\nand a text");
}

TEST(Fold, AWordWiderThanALineIsBrokenButNoName) {
  EXPECT_EQ(fold("  '0123456789'", 8), "  '01234\n  56789'");
  EXPECT_EQ(fold("ab 0123456789", 6), "ab\n012345\n6789");
  EXPECT_EQ(fold("in out/0123456789 b", 8), "in\nout/0123456789\nb");
}

TEST(Fold, ACommandCanStillBePasted) {
  EXPECT_EQ(fold("  replay  fieldproof run --endpoint 'exec:a b c' --out x\n", 40),
            "  replay  fieldproof run --endpoint \\\n            'exec:a b c' --out x\n");
}

TEST(Fold, AWordOfACommandThatIsWiderThanALineIsOneWordStill) {
  const std::string command =
      "fieldproof run --endpoint 'exec:./server 0011_for_1132 {tty} --name it'\\''s --more' --out "
      "x";
  for (std::size_t width = 30; width < 90; ++width) {
    const std::string folded = fold("  replay  " + command + "\n", width);
    std::string pasted = folded.substr(folded.find("fieldproof"));
    for (std::size_t at = 0, end = 0; (end = folded.find('\n', at)) != folded.npos; at = end + 1)
      EXPECT_LE(end - at, width) << folded;
    // As a shell reads it.
    const auto replace = [&](const std::string& from, const std::string& to) {
      for (std::size_t at = 0; (at = pasted.find(from, at)) != pasted.npos; at += to.size())
        pasted.replace(at, from.size(), to);
    };
    replace("'\\\n'", "");
    while (pasted.find(" \\\n ") != pasted.npos) replace(" \\\n ", " \\\n");
    replace(" \\\n", " ");
    replace("\\\n", "");
    EXPECT_EQ(pasted, command + "\n") << width << '\n' << folded;
  }
}

TEST(Fold, ColoursTakeNoColumns) {
  EXPECT_EQ(columns_of("\x1b[1;31mFAIL\x1b[0m"), 4u);
  EXPECT_EQ(fold("\x1b[1;31mFAIL\x1b[0m a b", 8), "\x1b[1;31mFAIL\x1b[0m a b");
}

TEST(Fold, CountsCharactersNotBytes) {
  EXPECT_EQ(columns_of("m\u00e4\u20ac"), 3u);
  EXPECT_EQ(columns_of("\uad6d\ubc88"), 4u) << "Hangul is wide";
  EXPECT_EQ(fold("\uad6d\ubc88", 3), "\uad6d\n\ubc88");
  EXPECT_EQ(fold("\u20ac\u20ac\u20ac\u20ac", 3), "\u20ac\u20ac\u20ac\n\u20ac");
}

TEST(Cut, SaysThatThereIsMore) {
  EXPECT_EQ(cut("Read one word", 13), "Read one word");
  EXPECT_EQ(cut("Read one word", 12), "Read one...");
  EXPECT_EQ(cut("Read one word", 2), "Re");
}

}  // namespace
}  // namespace fieldproof::text
