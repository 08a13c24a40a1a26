#include "harness/vectors/decisions.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

namespace fieldproof::vectors {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr std::string_view two = R"(# Decisions
Head.

## XGT
### cnet/order-of-checks
A request is checked in a fixed order.
Block count first.

### cnet/back-to-back
Two requests are both answered.
)";

/// Vectors of one case each, with this basis and these keys.
VectorSet with(const std::string& basis, const std::string& keys = "") {
  VectorSet set;
  load_vector_text(
      R"j([{"id": "xgt_cnet/a/b", "rev": 1, "title": "the title of it", "level": "must", "basis": ")j" +
          basis + R"j(", "why": "because it is so", )j" + keys + R"j(
    "statement": "m/1", "source": {"manual": "m", "section": "1", "quote": "one two three four five"},
    "each": {"n": [{"case": "one"}, {"case": "two"}]},
    "steps": [{"send": "[ENQ EOT]"}]}])j",
      "f.json", set);
  EXPECT_THAT(set.problems, IsEmpty());
  return set;
}

class DecisionFile : public testing::Test {
 protected:
  ~DecisionFile() override { std::filesystem::remove(file_); }
  void load(std::string_view text, VectorSet& set) {
    std::ofstream(file_) << text;
    load_decisions(file_, set);
  }
  const std::filesystem::path file_ = std::filesystem::temp_directory_path() /
                                      ("fieldproof-decisions-" + std::to_string(::getpid()));
};

TEST(Decisions, HaveAnIdAndAFirstSentence) {
  const std::vector<Decision> decisions = read_decisions(two);
  ASSERT_EQ(decisions.size(), 2u);
  EXPECT_EQ(decisions[0].id, "cnet/order-of-checks");
  EXPECT_EQ(decisions[0].sentence, "A request is checked in a fixed order.");
  EXPECT_EQ(decisions[1].id, "cnet/back-to-back");
  EXPECT_EQ(decisions[1].sentence, "Two requests are both answered.");
}

TEST(Decisions, AnEntryWithoutASentenceHasNone) {
  EXPECT_EQ(read_decisions("### a/b\n### a/c\nText.\n")[0].sentence, "");
  EXPECT_EQ(read_decisions("### a/b\n\nText.\n")[0].sentence, "");
  EXPECT_EQ(read_decisions("### a/b")[0].sentence, "");
}

TEST_F(DecisionFile, CasesCarryTheSentencesOfWhatTheyCite) {
  VectorSet set = with("decision", R"("decision": ["cnet/back-to-back"],)");
  load(two, set);
  EXPECT_THAT(lint_decisions(set), IsEmpty());
  ASSERT_EQ(set.cases.size(), 2u);
  for (const Case& one : set.cases) {
    ASSERT_EQ(one.decisions.size(), 1u);
    EXPECT_EQ(one.decisions[0].id, "cnet/back-to-back");
    EXPECT_EQ(one.decisions[0].sentence, "Two requests are both answered.");
  }
}

TEST_F(DecisionFile, TheOneReadFirstWins) {
  VectorSet set = with("decision", R"("decision": ["cnet/back-to-back"],)");
  load("### cnet/back-to-back\nMine.\n", set);
  load(two, set);
  EXPECT_EQ(set.cases[0].decisions[0].sentence, "Mine.");
  EXPECT_EQ(set.decisions.size(), 2u);
}

TEST_F(DecisionFile, AnIdIsUsedOnce) {
  VectorSet set;
  load("### a/b\nOne.\n### a/b\nTwo.\n", set);
  EXPECT_THAT(set.problems, ElementsAre(HasSubstr("the id a/b is used twice")));
}

TEST_F(DecisionFile, AMissingFileHasNoDecisions) {
  VectorSet set;
  load_decisions(file_, set);
  EXPECT_THAT(set.decisions, IsEmpty());
  EXPECT_THAT(set.problems, IsEmpty());
}

TEST_F(DecisionFile, AnUnknownIdIsNamedOnceAVectorWithTheNearestOne) {
  VectorSet set = with("decision", R"("decision": ["cnet/oder-of-checks"],)");
  load(two, set);
  EXPECT_THAT(lint_decisions(set),
              ElementsAre("f.json: xgt_cnet/a/b: no decision 'cnet/oder-of-checks' in "
                          "DECISIONS.md; did you mean 'cnet/order-of-checks'?"));
}

TEST(LintDecisions, ABasisOfDecisionCitesOne) {
  EXPECT_THAT(lint_decisions(with("decision")),
              ElementsAre(HasSubstr("f.json: xgt_cnet/a/b: its basis is a decision, but it cites "
                                    "none; add \"decision\": [\"ID\"]")));
  EXPECT_THAT(lint_decisions(with("derived")), IsEmpty());
}

TEST(LintDecisions, EntriesHaveAnIdAndASentence) {
  VectorSet set;
  set.decisions = {{"Order", "Fine."}, {"a/b", "no end"}};
  EXPECT_THAT(lint_decisions(set), ElementsAre(HasSubstr("'Order' is no id"),
                                               HasSubstr("a/b does not begin with a sentence")));
}

TEST_F(DecisionFile, WhatADeviceIsHeldToExists) {
  VectorSet set;
  load(two, set);
  EXPECT_TRUE(check_binding({.all = false, .named = {"cnet/back-to-back"}}, set));
  const Status lost = check_binding({.all = false, .named = {"cnet/back-to-bakc"}}, set);
  ASSERT_FALSE(lost);
  EXPECT_EQ(lost.error().message,
            "no decision 'cnet/back-to-bakc' in DECISIONS.md; did you mean 'cnet/back-to-back'?");
}

}  // namespace
}  // namespace fieldproof::vectors
