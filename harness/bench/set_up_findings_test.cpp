#include "harness/bench/set_up_findings.hpp"

#include <gmock/gmock.h>

namespace fieldproof::bench {
namespace {

using results::Verdict;
using testing::HasSubstr;

results::CaseResult blocked(const std::string& id, const std::string& message) {
  results::CaseResult result;
  result.id = id;
  result.protocol = "p";
  result.verdict = Verdict::blocked;
  result.message = message;
  return result;
}

TEST(SetUpFindings, AreOneForEachWayInWhichWritesFail) {
  SetUpFindings findings;
  findings.note(blocked("p/a/1", "set-up: cannot set %MW1: the device answers NAK 1132"));
  findings.note(blocked("p/a/2", "set-up: cannot set %MW2: the device answers NAK 1132"));
  findings.note(blocked("p/a/3", "set-up: cannot set %MW1: no answer"));
  findings.note(blocked("p/a/4", "writes %MW1; allow it with --allow-write M1"));
  findings.note(blocked("p/a/5", "set-up: cannot set %MW2: no answer" + std::string(not_tried)));
  const std::vector<results::CaseResult> results = findings.results();
  ASSERT_EQ(results.size(), 2u);
  EXPECT_EQ(results[1].id, "set_up/p/2");
  EXPECT_EQ(results[1].verdict, Verdict::fail);
  EXPECT_THAT(results[1].message,
              HasSubstr("cannot set %MW1: the device answers NAK 1132; 2 cases are BLOCKED by it, "
                        "first p/a/1"));
  EXPECT_THAT(results[0].message, HasSubstr("no answer; 2 cases are BLOCKED by it, first p/a/3"));
}

/// Two in a row that are not answered are seen on devices that others wrote, under load.
TEST(SetUpFindings, OneAnswerThatIsLostProvesNothing) {
  results::CaseResult judged = blocked("p/a/1", "");
  judged.verdict = Verdict::pass;
  const auto verdict_of = [&](const std::vector<results::CaseResult>& run) {
    SetUpFindings findings;
    for (const results::CaseResult& one : run) findings.note(one);
    return findings.results().at(0).verdict;
  };
  const results::CaseResult lost = blocked("p/a/2", "set-up: cannot set %MW1: no answer");
  const results::CaseResult refused =
      blocked("p/a/2", "set-up: cannot set %MW1: the device answers NAK 1132");
  EXPECT_EQ(verdict_of({lost, judged}), Verdict::inconclusive);
  EXPECT_EQ(verdict_of({lost}), Verdict::fail) << "nothing says that it answers at all";
  EXPECT_EQ(verdict_of({lost, judged, lost}), Verdict::fail);
  EXPECT_EQ(verdict_of({refused, judged}), Verdict::fail);
}

TEST(SetUpFindings, AreNoneWhereWritesAreTaken) {
  SetUpFindings findings;
  results::CaseResult failed = blocked("p/a/1", "set-up: cannot set %MW1: no answer");
  failed.verdict = Verdict::fail;
  findings.note(failed);
  EXPECT_TRUE(findings.results().empty());
}

}  // namespace
}  // namespace fieldproof::bench
