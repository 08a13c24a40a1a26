#include "reports/text/tally.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <initializer_list>

namespace fieldproof::text {

using results::Gate;
using results::Verdict;

namespace {

Tally tally_of(std::initializer_list<Verdict> verdicts) {
  Tally tally;
  for (Verdict verdict : verdicts) tally.add(verdict);
  return tally;
}

TEST(Tally, CasesOfAModelAreCountedApart) {
  Tally tally;
  results::CaseResult result;
  result.verdict = Verdict::pass;
  tally.add(result);
  EXPECT_EQ(on_model_text(tally), "");
  result.on_model = "register";
  for (int i = 0; i < 1200; ++i) tally.add(result);
  result.on_model = "instruction";
  tally.add(result);
  result.verdict = Verdict::skip;
  tally.add(result);
  EXPECT_EQ(on_model_text(tally),
            "on a model, not on a wire: 1,201 (1 instruction, 1,200 register)");
  EXPECT_EQ(tally.total(), 1203u);
}

TEST(Tally, EachVerdictStandsOnceInItsList) {
  for (std::size_t i = 0; i < Tally::verdicts.size(); ++i)
    EXPECT_EQ(i, static_cast<std::size_t>(Tally::verdicts[i]));
}

TEST(Tally, SaysWhatOccurs) {
  EXPECT_EQ("nothing", to_string(Tally{}));
  EXPECT_EQ("2 PASS, 1 FAIL, 1 ERROR",
            to_string(tally_of({Verdict::error, Verdict::pass, Verdict::fail, Verdict::pass})));
}

std::string why(std::initializer_list<Verdict> verdicts, const Gate& gate = {}) {
  const std::vector<results::Reason> reasons = reasons_of(tally_of(verdicts), gate);
  return fmt::format("{} {}", results::exit_code_of(reasons), results::to_string(reasons));
}

TEST(Reasons, ByPrecedence) {
  EXPECT_EQ("3 bench trouble: 1 ERROR; conformance failed: 1 FAIL",
            why({Verdict::error, Verdict::fail, Verdict::pass}));
  EXPECT_EQ("1 conformance failed: 1 FAIL", why({Verdict::fail, Verdict::skip}));
  EXPECT_EQ("1 conformance failed: 1 XPASS", why({Verdict::xpass, Verdict::pass}));
  EXPECT_EQ("4 nothing selected or executed", why({Verdict::skip, Verdict::blocked}));
  EXPECT_EQ("4 nothing selected or executed", why({}));
  EXPECT_EQ("0 ", why({Verdict::pass, Verdict::skip}));
  EXPECT_EQ("0 ", why({Verdict::xfail}));
}

TEST(Reasons, OfEachVerdictAlone) {
  const auto code = [](Verdict verdict, const Gate& gate) {
    return results::exit_code_of(reasons_of(tally_of({verdict}), gate));
  };
  EXPECT_EQ(0, code(Verdict::pass, {}));
  EXPECT_EQ(0, code(Verdict::info, {}));
  EXPECT_EQ(0, code(Verdict::marginal, {}));
  EXPECT_EQ(1, code(Verdict::marginal, {.fail_on_marginal = true}));
  EXPECT_EQ(0, code(Verdict::non_strict, {}));
  EXPECT_EQ(1, code(Verdict::non_strict, {.strict = true}));
  EXPECT_EQ(4, code(Verdict::inconclusive, {})) << "green with nothing judged would be a lie";
  EXPECT_EQ(1, code(Verdict::inconclusive, {.qualify = true}));
  EXPECT_EQ(4, code(Verdict::blocked, {}));
  EXPECT_EQ(1, code(Verdict::blocked, {.qualify = true}));
  EXPECT_EQ(4, code(Verdict::skip, {.strict = true, .fail_on_marginal = true, .qualify = true}));
}

TEST(Reasons, AQualificationWithNothingFailedIsNoFailure) {
  EXPECT_EQ("1 not qualified: 2 not judged",
            why({Verdict::pass, Verdict::blocked, Verdict::inconclusive}, {.qualify = true}));
  EXPECT_EQ("1 conformance failed: 1 FAIL; not qualified: 1 not judged",
            why({Verdict::fail, Verdict::blocked}, {.qualify = true}));
}

TEST(Reasons, TooLittleJudged) {
  Tally tally;
  tally.add(Verdict::pass, 1800);
  tally.add(Verdict::blocked, 200);
  tally.add(Verdict::skip, 5000);  // no device could be judged by them
  EXPECT_EQ("1,800 of 2,000 judged", judged_text(tally));
  EXPECT_TRUE(reasons_of(tally, {.min_judged = 90}).empty());
  tally.add(Verdict::inconclusive);
  const std::vector<results::Reason> reasons = reasons_of(tally, {.min_judged = 90});
  EXPECT_EQ("too little judged: 1,800 of 2,001 judged (90.0%), --min-judged asks for 90%",
            results::to_string(reasons));
  EXPECT_EQ(1, results::exit_code_of(reasons));
}

TEST(JunitOutcome, FollowsTheGateExceptForWhatWasNotJudged) {
  const Gate all{.strict = true, .fail_on_marginal = true, .qualify = true};
  EXPECT_EQ(JunitOutcome::plain, junit_outcome(Verdict::pass, all));
  EXPECT_EQ(JunitOutcome::plain, junit_outcome(Verdict::info, all));
  EXPECT_EQ(JunitOutcome::plain, junit_outcome(Verdict::marginal, {}));
  EXPECT_EQ(JunitOutcome::failure, junit_outcome(Verdict::marginal, all));
  EXPECT_EQ(JunitOutcome::plain, junit_outcome(Verdict::non_strict, {}));
  EXPECT_EQ(JunitOutcome::failure, junit_outcome(Verdict::non_strict, all));
  EXPECT_EQ(JunitOutcome::failure, junit_outcome(Verdict::fail, {}));
  EXPECT_EQ(JunitOutcome::failure, junit_outcome(Verdict::xpass, {}));
  EXPECT_EQ(JunitOutcome::error, junit_outcome(Verdict::error, {}));
  for (Verdict verdict : {Verdict::skip, Verdict::blocked, Verdict::inconclusive, Verdict::xfail}) {
    EXPECT_EQ(JunitOutcome::skipped, junit_outcome(verdict, {}));
    EXPECT_EQ(JunitOutcome::skipped, junit_outcome(verdict, all));
  }
}

TEST(GateText, ReadsBack) {
  for (int bits = 0; bits < 8; ++bits) {
    const Gate gate{
        .strict = (bits & 1) != 0, .fail_on_marginal = (bits & 2) != 0, .qualify = (bits & 4) != 0};
    const Gate again = parse_gate(to_string(gate));
    EXPECT_EQ(gate.strict, again.strict) << bits;
    EXPECT_EQ(gate.fail_on_marginal, again.fail_on_marginal) << bits;
    EXPECT_EQ(gate.qualify, again.qualify) << bits;
  }
  EXPECT_EQ("qualify, min-judged 92.5%", to_string(Gate{.qualify = true, .min_judged = 92.5}));
  EXPECT_EQ(92.5, parse_gate("qualify, min-judged 92.5%").min_judged);
  EXPECT_EQ("default", to_string(Gate{}));
  EXPECT_EQ("strict, fail-on marginal", to_string(Gate{.strict = true, .fail_on_marginal = true}));
  EXPECT_FALSE(parse_gate("stricter").strict);
}

}  // namespace
}  // namespace fieldproof::text
