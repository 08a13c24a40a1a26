#include "harness/run/soak_log.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "reports/results/result_json.hpp"

namespace fieldproof::run {

using results::Verdict;

namespace {

using testing::HasSubstr;

results::CaseResult repetition(const std::string& id, int repeat, Verdict verdict = Verdict::pass,
                               std::vector<double> ms = {1}) {
  results::CaseResult result;
  result.id = id;
  result.repeat = repeat;
  result.verdict = verdict;
  result.response_ms = std::move(ms);
  return result;
}

TEST(SoakLog, TheFirstOfEachCaseAndFailuresAreWritten) {
  SoakLog log(100, {});
  EXPECT_TRUE(log.take(repetition("a", 0), 0));
  EXPECT_TRUE(log.take(repetition("b", 0, Verdict::skip, {}), 0));
  EXPECT_FALSE(log.take(repetition("a", 1), 1));
  EXPECT_TRUE(log.take(repetition("a", 2, Verdict::fail), 2));
  EXPECT_FALSE(log.take(repetition("a", 3, Verdict::non_strict), 3));
  const results::SoakSummary summary = log.summary(4);
  EXPECT_EQ(4u, summary.rounds);
  EXPECT_EQ(4u, summary.judged) << "a skipped case is no repetition";
  EXPECT_EQ(1u, summary.failed);
  EXPECT_EQ(0.25, summary.error_rate());
  EXPECT_EQ((std::map<std::string, std::uint64_t>{{"PASS", 2}, {"FAIL", 1}, {"NON-STRICT", 1}}),
            summary.cases.at("a").counts);
}

TEST(SoakLog, FailuresBeyondTheRoomAreCounted) {
  SoakLog log(1e6, {});
  std::uint64_t written = 0;
  for (int i = 0; i < 100; ++i) written += log.take(repetition("always", i, Verdict::fail), i);
  EXPECT_EQ(1 + SoakLog::failures_a_case, written);
  EXPECT_EQ(99 - SoakLog::failures_a_case, log.summary(100).unwritten);
  EXPECT_TRUE(log.take(repetition("rare", 0), 100));
  EXPECT_TRUE(log.take(repetition("rare", 101, Verdict::fail), 101))
      << "a rare failure still has room";
  EXPECT_THAT(results::soak_text(log.summary(102)), HasSubstr("79 more are counted"));
}

/// From 1 ms to 2 ms over the time: the last tenth is slower than the first by about 90 %.
TEST(SoakLog, DriftIsTheLastTenthAgainstTheFirst) {
  SoakLog log(1000, {});
  for (int i = 0; i < 100'000; ++i)
    log.take(repetition("a", i, i < 99'000 ? Verdict::pass : Verdict::fail, {1 + i * 1e-5}),
             i * 0.01);
  const results::SoakSummary summary = log.summary(1000);
  EXPECT_NEAR(1.05, summary.first.response.median, 0.02);
  EXPECT_NEAR(1.95, summary.last.response.median, 0.02);
  EXPECT_NEAR(10'000, static_cast<double>(summary.first.judged), 1000)
      << "a stretch is about one percent of the time";
  EXPECT_EQ(0u, summary.first.failed);
  EXPECT_EQ(1000u, summary.last.failed);
  EXPECT_THAT(results::soak_text(summary), HasSubstr("median +8"));
}

/// Whenever it is interrupted, there are tenths.
TEST(SoakLog, AnInterruptedSoakHasTenthsOfItsOwn) {
  SoakLog log(28'800, {});
  for (int i = 0; i < 1000; ++i)
    log.take(repetition("a", i, Verdict::pass, {i < 500 ? 1.0 : 3.0}), i * 0.002);
  const results::SoakSummary summary = log.summary(2);
  EXPECT_DOUBLE_EQ(1, summary.first.response.median);
  EXPECT_DOUBLE_EQ(3, summary.last.response.median);
}

TEST(SoakLog, SamplesAreBounded) {
  SoakLog log(28'800, {});
  int samples = 0;
  std::uint64_t judged = 0;
  for (int second = 0; second < 28'800; ++second) {
    log.take(repetition("a", second), second);
    if (const auto due = log.due_sample(second)) ++samples, judged += due->judged;
  }
  EXPECT_LE(samples, 500);
  EXPECT_GT(samples, 450);
  EXPECT_GT(judged, 28'000u);
}

TEST(SoakLog, NothingToSoak) {
  SoakLog log(10, {});
  log.take(repetition("a", 0, Verdict::blocked, {}), 0);
  EXPECT_FALSE(log.idle(0));
  EXPECT_TRUE(log.idle(1));
}

TEST(SoakLog, TheSummaryComesBackFromJson) {
  SoakLog log(100, {});
  log.take(repetition("a", 0), 0);
  log.take(repetition("a", 1, Verdict::fail), 50);
  std::string written, again;
  append_json(written, log.summary(60));
  append_json(again, nlohmann::json::parse(written).get<results::SoakSummary>());
  EXPECT_THAT(written, testing::HasSubstr("\"a\""));
  EXPECT_EQ(written, again);
}

}  // namespace
}  // namespace fieldproof::run
