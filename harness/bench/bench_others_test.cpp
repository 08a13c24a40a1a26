#include "harness/bench/test_bench.hpp"

namespace fieldproof::bench {

using results::CaseResult;
using results::Verdict;
using test::Pieces;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;

namespace {

class SharedLine : public test::ScriptedBench {
 protected:
  SharedLine() {
    on_real_device();
    endpoint.can.shared = true;
  }
  CaseResult run_ask() { return run(vector(ask())); }

  /// Behind each answer to this request, one that somebody else has asked for.
  void others_hear(const std::string& request) {
    endpoint.answers[request].push_back({5ms, "<theirs>"});
  }
};

TEST_F(SharedLine, WhoIsAloneJudgesAsEver) {
  ASSERT_TRUE(bench().start());
  EXPECT_EQ(run_ask().verdict, Verdict::pass);
  endpoint.answers["<ask>"] = Pieces{{1ms, "<wrong!>"}};
  const CaseResult result = run_ask();
  EXPECT_EQ(result.verdict, Verdict::fail) << "nobody else was heard";
  EXPECT_FALSE(result.recording.empty());
}

TEST_F(SharedLine, AnswersToOthersBeforeTheFirstCaseEndTheRun) {
  others_hear("<probe>");
  const Status started = bench().start();
  ASSERT_FALSE(started);
  EXPECT_THAT(started.error().message,
              AllOf(HasSubstr("somebody else speaks on scripted"), HasSubstr("<theirs>"),
                    HasSubstr("max-connections: 1"), HasSubstr("shared=off")));
}

TEST_F(SharedLine, BytesThatTheCaseDidNotAskForAreNoFailure) {
  ASSERT_TRUE(bench().start());
  others_hear("<ask>");
  const CaseResult result = run_ask();
  EXPECT_EQ(result.verdict, Verdict::inconclusive);
  EXPECT_THAT(result.message, HasSubstr("somebody else speaks on scripted"));
  ASSERT_FALSE(result.notes.empty());
  EXPECT_THAT(result.notes.back(), HasSubstr("nobody else heard, it would be FAIL: "));
  EXPECT_TRUE(result.recording.empty()) << "`judge` would make a failure of it";
}

/// Two requests at once, and the device has understood neither.
TEST_F(SharedLine, AFailureIsLookedAtTwice) {
  ASSERT_TRUE(bench().start());
  endpoint.answers["<ask>"].clear();
  others_hear("<probe>");
  EXPECT_EQ(run_ask().verdict, Verdict::inconclusive);
  endpoint.answers["<probe>"].pop_back();
  EXPECT_EQ(run_ask().verdict, Verdict::inconclusive) << "they were heard a moment ago";
}

TEST_F(SharedLine, WhoStaysEndsTheRun) {
  ASSERT_TRUE(bench().start());
  others_hear("<ask>");
  for (int i = 0; i < 4; ++i) EXPECT_EQ(run_ask().verdict, Verdict::inconclusive);
  EXPECT_THAT(bench().stopped(), IsEmpty());
  EXPECT_EQ(run_ask().verdict, Verdict::inconclusive);
  EXPECT_THAT(bench().stopped(), HasSubstr("somebody else speaks on scripted"));
  EXPECT_EQ(run_ask().verdict, Verdict::blocked);
}

TEST_F(SharedLine, ADeviceThatNobodyElseReachesFails) {
  others_hear("<ask>");
  endpoint.lets_in = false;
  ASSERT_TRUE(bench().start());
  EXPECT_EQ(run_ask().verdict, Verdict::fail);
  endpoint.lets_in = true;
  endpoint.can.shared = false;
  EXPECT_EQ(run_ask().verdict, Verdict::fail) << "a port of this computer";
}

TEST_F(SharedLine, ABabblerBehindAServerThatLetsNobodyElseInIsJudged) {
  others_hear("<probe>");
  endpoint.lets_in = false;
  EXPECT_TRUE(bench().start());
}

}  // namespace
}  // namespace fieldproof::bench
