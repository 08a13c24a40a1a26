#include "harness/vectors/json/pieces.hpp"

#include <gmock/gmock.h>

namespace fieldproof::vectors {
namespace {

TEST(Pieces, EachObjectWithItsIdAndLine) {
  const auto pieces =
      cut("[\n  {\"id\": \"a/b\", \"x\": [{\"id\": \"inner\"}]},\n\n {\"y\": 1,\n"
          " \"id\" : \"c\"}\n]\n");
  ASSERT_TRUE(pieces);
  ASSERT_EQ(pieces->size(), 2u);
  EXPECT_EQ((*pieces)[0].text, "{\"id\": \"a/b\", \"x\": [{\"id\": \"inner\"}]}");
  EXPECT_EQ((*pieces)[0].id, "a/b");
  EXPECT_EQ((*pieces)[0].line, 2);
  EXPECT_EQ((*pieces)[1].id, "c");
  EXPECT_EQ((*pieces)[1].line, 4);
}

TEST(Pieces, BracketsAndQuotesInTextsAreText) {
  const auto pieces = cut(R"([{"t": "]}\"{[", "u": "\\", "id": "a"}])");
  ASSERT_TRUE(pieces);
  EXPECT_EQ(pieces->front().id, "a");
}

TEST(Pieces, AValueIdIsNoKey) {
  const auto pieces = cut(R"([{"kind": "id", "id": "a"}, {"id": 7}, {}])");
  ASSERT_TRUE(pieces);
  EXPECT_EQ((*pieces)[0].id, "a");
  EXPECT_EQ((*pieces)[1].id, "");
  EXPECT_EQ((*pieces)[2].id, "");
}

TEST(Pieces, OneObjectAloneAndAnEmptyList) {
  EXPECT_EQ(cut(" {\"id\": \"a\"} ")->size(), 1u);
  EXPECT_EQ(cut("[ ]")->size(), 0u);
}

TEST(Pieces, WhatIsBrokenBetweenObjectsIsNotCut) {
  for (const char* broken :
       {"", "7", "[", "[{}", "[{},]", "[,{}]", "[{} {}]", "[{}] x", "[{}, 7]", "{} {}", "[{]",
        "[{\"a\": \"b}]", "[{\"a\": \"\\\"}]", "[{\"a\": \"\\"})
    EXPECT_FALSE(cut(broken)) << broken;
}

}  // namespace
}  // namespace fieldproof::vectors
