#include "harness/vectors/json/shape.hpp"

#include <gmock/gmock.h>

#include <array>
#include <nlohmann/json.hpp>

namespace fieldproof::vectors {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using Kind = Shape::Kind;

constexpr Shape one_text{.least = 1};
constexpr Shape one_number{.kind = Kind::number, .least = 1, .most = 9};
constexpr Shape some_texts{.kind = Kind::list, .least = 1, .items = &one_text};
constexpr Shape text_or_texts{.least = 1, .instead = &some_texts};
constexpr std::array<std::string_view, 3> levels{"must", "should", "info"};
constexpr Shape one_level{.words = levels};
constexpr Shape filled_level{.words = levels, .filled = true};
constexpr Form even{"an even text", "^(..)*$",
                    [](std::string_view t) { return t.size() % 2 == 0; }};
constexpr Shape even_text{.form = &even};
constexpr Shape yes{.kind = Kind::yes};
constexpr Shape some_numbers{.kind = Kind::object, .open = true, .others = &one_number};
constexpr std::array inner_keys{Key{"wait", &even_text}, Key{"times", &one_number}};
constexpr Shape inner{.kind = Kind::object, .keys = inner_keys};
constexpr Shape inners{.kind = Kind::list, .items = &inner};
constexpr std::array<std::string_view, 1> info_alone{"info"};
constexpr std::array demands{Demand{"level", info_alone, "why", "numbers"}};
constexpr std::array own_keys{Key{"title", &one_text, true}, Key{"level", &one_level},
                              Key{"other", &filled_level},   Key{"names", &text_or_texts},
                              Key{"steps", &inners},         Key{"silence", &yes},
                              Key{"why", &one_text},         Key{"numbers", &some_numbers}};
constexpr Shape document{.kind = Kind::object, .keys = own_keys, .demands = demands};

std::vector<std::string> problems(const char* json) {
  return shape_problems(nlohmann::ordered_json::parse(json), document);
}

TEST(Shape, WhatIsRightIsSilent) {
  EXPECT_THAT(problems(R"({"title": "t", "level": "must", "other": "${level}", "names": ["a", "b"],
      "steps": [{"wait": "ab", "times": 9}], "silence": true, "numbers": {"any": 1}})"),
              IsEmpty());
  EXPECT_THAT(problems(R"({"title": "t", "names": "a", "numbers": {}})"), IsEmpty());
}

TEST(Shape, AMistypedKeyIsOneProblemWithTheRightWord) {
  EXPECT_THAT(problems(R"({"titel": "t", "numbers": {}})"),
              ElementsAre("unknown key 'titel'; did you mean 'title'?"));
  EXPECT_THAT(problems(R"({"title": "t", "numbers": {}, "steps": [{"xyz": 1}]})"),
              ElementsAre("steps[0]: unknown key 'xyz'; there are wait, times"));
}

TEST(Shape, AKeyThatIsThereIsNotWhatWasMeant) {
  EXPECT_THAT(problems(R"({"title": "t", "titles": "t", "numbers": {}})"),
              ElementsAre(testing::HasSubstr("unknown key 'titles'; there are title, level")));
}

TEST(Shape, TheWholePathIsNamed) {
  EXPECT_THAT(
      problems(
          R"({"title": "t", "numbers": {"b": "1"}, "steps": [{}, {"wait": "abc", "times": 0}]})"),
      ElementsAre("numbers.b: is \"1\"; write a whole number",
                  "steps[1].wait: 'abc' is not an even text",
                  "steps[1].times: is 0; write 1 to 9"));
}

TEST(Shape, WordsAreListed) {
  EXPECT_THAT(problems(R"({"title": "t", "level": "musst", "numbers": {}})"),
              ElementsAre("level: 'musst' is none of must, should, info; did you mean 'must'?"));
}

TEST(Shape, AnotherKindIsNamed) {
  EXPECT_THAT(problems(R"({"title": 7, "silence": false, "names": 7, "steps": {}, "numbers": {}})"),
              ElementsAre("title: is 7; write a text", "silence: is false; write true",
                          "names: is 7; write a list", "steps: is an object; write a list"));
  EXPECT_THAT(shape_problems("x", document), ElementsAre("is \"x\"; write an object"));
}

TEST(Shape, SizesHaveLimits) {
  EXPECT_THAT(problems(R"({"title": "", "names": [], "numbers": {}})"),
              ElementsAre("title: has 0 characters; it needs at least 1",
                          "names: has 0 items; it needs at least 1"));
}

TEST(Shape, WhatOneWordDemandsMustBeThere) {
  EXPECT_THAT(problems(R"({"title": "t", "level": "info"})"), ElementsAre("lacks 'why'"));
  EXPECT_THAT(problems(R"({"title": "t", "level": "must"})"), ElementsAre("lacks 'numbers'"));
  EXPECT_THAT(problems(R"({"title": "t"})"), ElementsAre("lacks 'numbers'"));
}

}  // namespace
}  // namespace fieldproof::vectors
