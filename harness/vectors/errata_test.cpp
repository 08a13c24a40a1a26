#include "harness/vectors/errata.hpp"

#include <gmock/gmock.h>

#include <regex>

namespace fieldproof::vectors::errata_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const std::string two = R"j([
  {"id": "m_7/tail", "kind": "wrong bytes", "places": ["m/1"], "printed": "H04", "right": "H03",
   "proof": [{"manual": "m", "section": "2", "quote": "ETX is H03", "statement": "m/2"}],
   "why": "the table says so", "effect": "waits for a tail"},
  {"id": "m_7/chapter", "kind": "wrong reference", "printed": "9", "right": "11",
   "places": [{"manual": "m", "section": "1", "quote": "see chapter 9"}],
   "proof": ["m/2"], "why": "the table says so", "effect": "finds nothing", "doubt": "scanned text"}
])j";

VectorSet load(const std::string& text) {
  VectorSet set;
  set.manuals = {{"m", "m.txt", "M", ""}};
  set.statements = {{"m/1", "m", "7.1", "the tail ETX is H04", ""},
                    {"m/2", "m", "2", "ETX is H03 in every frame", ""}};
  load_errata(text, "errata/m_7.json", set);
  resolve_errata(set);
  return set;
}

std::string changed(const std::string& from, const std::string& to) {
  std::string text = two;
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(Errata, HaveTheWordsOfTheirStatements) {
  const VectorSet set = load(two);
  EXPECT_THAT(set.problems, IsEmpty());
  EXPECT_THAT(lint_errata(set), IsEmpty());
  ASSERT_EQ(2u, set.errata.size());
  const Passage& place = set.errata[0].places.at(0);
  EXPECT_EQ("m 7.1 the tail ETX is H04", place.manual + " " + place.section + " " + place.quote);
  EXPECT_EQ("ETX is H03", set.errata[0].proof.at(0).quote) << "its own, not the statement's";
  EXPECT_EQ("scanned text", set.errata[1].doubt);
  EXPECT_THAT(statements_of(set.errata[0]), ElementsAre("m/1", "m/2"));
}

TEST(Errata, WrongShapesAreNamedByFileAndLine) {
  EXPECT_THAT(load(changed("wrong bytes", "wrong byte")).problems,
              ElementsAre("errata/m_7.json:2: m_7/tail: kind: 'wrong byte' is none of wrong bytes, "
                          "contradiction, wrong number, wrong reference, wording; did you mean "
                          "'wrong bytes'?"));
  const VectorSet set = load(changed("\"printed\": \"9\", ", ""));
  EXPECT_THAT(set.problems, ElementsAre("errata/m_7.json:5: m_7/chapter: lacks 'printed'"));
  EXPECT_EQ(1u, set.errata.size()) << "the other is sound";
  EXPECT_THAT(load(changed("\"section\": \"2\", ", "")).problems,
              ElementsAre(HasSubstr("proof[0]: lacks 'section'")));
  EXPECT_THAT(load(changed("m_7/tail", "tail")).problems,
              ElementsAre(HasSubstr("id: 'tail' is not an id such as chapter_7/ack_tail")));
}

TEST(Errata, WhatTheyCiteIsThere) {
  EXPECT_THAT(lint_errata(load(changed("\"m/1\"", "\"m/12\""))),
              ElementsAre("errata/m_7.json:2: m_7/tail: places[0]: no statement 'm/12' in "
                          "statements/; did you mean 'm/1'?"));
  EXPECT_THAT(lint_errata(load(changed("\"manual\": \"m\", \"section\": \"1\"",
                                       "\"manual\": \"n\", \"section\": \"1\""))),
              ElementsAre(HasSubstr("m_7/chapter: places[0]: no manual 'n' in manuals.json")));
  EXPECT_THAT(lint_errata(load(changed("\"manual\": \"m\", \"section\": \"2\"",
                                       "\"manual\": \"n\", \"section\": \"2\""))),
              ElementsAre(HasSubstr("the statement m/2 is not of the manual n")));
  EXPECT_THAT(lint_errata(load(changed("m_7/chapter", "m_7/tail"))),
              ElementsAre("errata/m_7.json:5: m_7/tail: the id is used twice"));
}

TEST(ErratumShape, PatternAndCodeAgree) {
  const Form& form = *std::ranges::find(erratum_shape().keys, "id", &Key::name)->shape->form;
  for (const char* id : {"cnet_7/ack_tail", "a/b/c", "a//b", "a", "/a", "a/", "A/b", "a-b/c", ""})
    EXPECT_EQ(form.fits(id), std::regex_search(id, std::regex(std::string(form.pattern)))) << id;
}

}  // namespace
}  // namespace fieldproof::vectors::errata_test
