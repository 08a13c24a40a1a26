#include "src/base/json_trouble.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace fieldproof {
namespace {

std::string trouble(const std::string& text) {
  try {
    return nlohmann::json::parse(text).get<std::string>();
  } catch (const std::exception& error) {
    return json_trouble(error);
  }
}

TEST(JsonTrouble, names_the_place_and_what_is_due_there) {
  const std::string too_many = "; is there a comma too many before it?";
  EXPECT_EQ("line 2, column 1: there is '}' where a text in quotes is due" + too_many,
            trouble("{\"a\": 1,\n}"));
  EXPECT_EQ("line 1, column 5: there is ']' where a value is due" + too_many, trouble("[1, ]"));
  EXPECT_EQ("line 1, column 4: there is ',' where a value is due; is there a comma too many?",
            trouble("[1,,2]"));
  EXPECT_EQ(
      "line 2, column 3: there is a text in quotes where ',' or '}' is due; is a comma missing "
      "before it?",
      trouble("{\"a\": 1\n\"b\": 2}"));
  EXPECT_EQ("line 1, column 6: there is a number where ':' is due", trouble("{\"a\" 1}"));
  EXPECT_EQ("line 1, column 7: the file ends where a value is due; is it complete?",
            trouble("{\"a\": "));
  EXPECT_EQ("line 1, column 3: there is ']' where the end of the file is due", trouble("[]]"));
}

TEST(JsonTrouble, of_letters_is_named_by_them) {
  EXPECT_EQ("line 1, column 5: invalid literal; last read: '[nul]'", trouble("[nul]"));
  EXPECT_NE(trouble("\"\xFF\"").find("UTF-8"), std::string::npos);
}

TEST(JsonTrouble, without_the_name_of_an_exception) {
  EXPECT_EQ("type must be string, but is number", trouble("1"));
  EXPECT_EQ("anything else", json_trouble(std::runtime_error("anything else")));
}

}  // namespace
}  // namespace fieldproof
