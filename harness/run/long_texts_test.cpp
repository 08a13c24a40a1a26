#include "harness/run/long_texts.hpp"

#include <gmock/gmock.h>

namespace fieldproof::run {
namespace {

results::CaseResult noted(const std::string& id, const std::string& note) {
  results::CaseResult result;
  result.id = id;
  result.message = note;
  result.notes = {"short", note};
  return result;
}

TEST(LongTexts, AreSaidOnceAndBounded) {
  const std::string digits = "not put back %MW0-%MW3839 = " + std::string(15'360, '7');
  LongTexts texts;
  results::CaseResult first = noted("a/one", digits), second = noted("a/two", digits);
  texts.shorten(first);
  texts.shorten(second);
  EXPECT_LE(first.notes[1].size(), 1000u);
  EXPECT_LE(first.message.size(), 1000u);
  EXPECT_THAT(first.notes[1], testing::HasSubstr("(14588 characters left out)"));
  EXPECT_THAT(first.notes[1], testing::StartsWith("not put back %MW0-%MW3839 = 777"));
  EXPECT_LE(second.notes[1].size(), 120u);
  EXPECT_THAT(second.notes[1], testing::StartsWith("not put back %MW0-%MW3839 = 777"));
  EXPECT_THAT(second.notes[1], testing::EndsWith(" ..., in full at a/one"));
  EXPECT_EQ("short", second.notes[0]);
}

TEST(LongTexts, ShortOnesStayAsTheyAre) {
  LongTexts texts;
  for (int i = 0; i < 2; ++i) {
    results::CaseResult result = noted("a/one", "transposed: %MW100 to %MW120");
    texts.shorten(result);
    EXPECT_EQ("transposed: %MW100 to %MW120", result.notes[1]);
  }
}

}  // namespace
}  // namespace fieldproof::run
