#include "src/base/nesting.hpp"

#include <gtest/gtest.h>

#include <string>

namespace fieldproof {
namespace {

TEST(Nesting, ends_where_it_is_too_deep) {
  const std::string deep(deepest_nesting, '[');
  EXPECT_EQ(not_too_deep(deep + "1"), deep + "1");
  EXPECT_EQ(not_too_deep(deep + "[1"), deep);
  EXPECT_EQ(not_too_deep(deep + "{\"a\""), deep);
  EXPECT_EQ(not_too_deep(""), "");
}

TEST(Nesting, brackets_in_texts_are_none) {
  const std::string brackets(1000, '[');
  const std::string text = "{\"a\\\"" + brackets + "\": \"" + brackets + "\\\\\", \"b\": []}";
  EXPECT_EQ(not_too_deep(text), text);
}

TEST(Nesting, what_is_closed_again_does_not_count) {
  std::string text;
  for (int i = 0; i < 1000; ++i) text += "[{}],";
  EXPECT_EQ(not_too_deep(text), text);
}

}  // namespace
}  // namespace fieldproof
