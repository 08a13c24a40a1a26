#include "reports/text/tally.hpp"

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

TEST(Tally, EachVerdictStandsOnceInItsList) {
  for (std::size_t i = 0; i < Tally::verdicts.size(); ++i)
    EXPECT_EQ(i, static_cast<std::size_t>(Tally::verdicts[i]));
}

TEST(Tally, SaysWhatOccurs) {
  EXPECT_EQ("nothing", to_string(Tally{}));
  EXPECT_EQ("2 PASS, 1 FAIL, 1 ERROR",
            to_string(tally_of({Verdict::error, Verdict::pass, Verdict::fail, Verdict::pass})));
}

TEST(GateExitCode, ByPrecedence) {
  const Gate gate;
  EXPECT_EQ(130, gate_exit_code(tally_of({Verdict::error, Verdict::fail}), gate, true));
  EXPECT_EQ(3,
            gate_exit_code(tally_of({Verdict::error, Verdict::fail, Verdict::pass}), gate, false));
  EXPECT_EQ(1, gate_exit_code(tally_of({Verdict::fail, Verdict::skip}), gate, false));
  EXPECT_EQ(1, gate_exit_code(tally_of({Verdict::xpass, Verdict::pass}), gate, false));
  EXPECT_EQ(4, gate_exit_code(tally_of({Verdict::skip, Verdict::blocked}), gate, false));
  EXPECT_EQ(4, gate_exit_code(Tally{}, gate, false));
  EXPECT_EQ(0, gate_exit_code(tally_of({Verdict::pass, Verdict::skip}), gate, false));
  EXPECT_EQ(0, gate_exit_code(tally_of({Verdict::xfail}), gate, false));
}

TEST(GateExitCode, EachVerdictAlone) {
  const auto code = [](Verdict verdict, const Gate& gate) {
    return gate_exit_code(tally_of({verdict}), gate, false);
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
  EXPECT_EQ("default", to_string(Gate{}));
  EXPECT_EQ("strict, fail-on marginal", to_string(Gate{.strict = true, .fail_on_marginal = true}));
  EXPECT_FALSE(parse_gate("stricter").strict);
}

}  // namespace
}  // namespace fieldproof::text
