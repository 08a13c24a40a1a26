#include "reports/results/verdict.hpp"

#include <gmock/gmock.h>

#include <string>
#include <vector>

namespace fieldproof::results {
namespace {

const std::vector<Verdict> all = {Verdict::pass,         Verdict::marginal, Verdict::non_strict,
                                  Verdict::info,         Verdict::fail,     Verdict::xfail,
                                  Verdict::xpass,        Verdict::skip,     Verdict::blocked,
                                  Verdict::inconclusive, Verdict::error};

std::vector<std::string> gating(const Gate& gate) {
  std::vector<std::string> words;
  for (Verdict verdict : all) {
    if (gates(verdict, gate)) words.emplace_back(to_string(verdict));
  }
  return words;
}

TEST(Verdict, WordsAsInTheDesign) {
  std::vector<std::string> words;
  for (Verdict verdict : all) words.emplace_back(to_string(verdict));
  EXPECT_THAT(words, testing::ElementsAre("PASS", "MARGINAL", "NON-STRICT", "INFO", "FAIL", "XFAIL",
                                          "XPASS", "SKIP", "BLOCKED", "INCONCLUSIVE", "ERROR"));
}

TEST(Verdict, WordsReadBack) {
  for (Verdict verdict : all) EXPECT_EQ(verdict, parse_verdict(to_string(verdict)));
  EXPECT_EQ(std::nullopt, parse_verdict("pass"));
  EXPECT_EQ(std::nullopt, parse_verdict("NON_STRICT"));
  EXPECT_EQ(std::nullopt, parse_verdict(""));
}

TEST(Verdict, EachOptionOfTheGateAddsItsOwn) {
  using testing::ElementsAre;
  EXPECT_THAT(gating({}), ElementsAre("FAIL", "XPASS", "ERROR"));
  EXPECT_THAT(gating({.strict = true}), ElementsAre("NON-STRICT", "FAIL", "XPASS", "ERROR"));
  EXPECT_THAT(gating({.fail_on_marginal = true}),
              ElementsAre("MARGINAL", "FAIL", "XPASS", "ERROR"));
  EXPECT_THAT(gating({.qualify = true}),
              ElementsAre("FAIL", "XPASS", "BLOCKED", "INCONCLUSIVE", "ERROR"));
}

}  // namespace
}  // namespace fieldproof::results
