#include "reports/results/response_times.hpp"

#include <gtest/gtest.h>

namespace fieldproof::results {
namespace {

TEST(ResponseTimes, EqualTimesStayExact) {
  ResponseTimes times;
  for (int i = 0; i < 1000; ++i) times.add(1.0416666);
  times.add(40);
  EXPECT_EQ(1001u, times.count());
  EXPECT_DOUBLE_EQ(1.0416666, times.least());
  EXPECT_DOUBLE_EQ(1.0416666, times.median());
  EXPECT_DOUBLE_EQ(1.0416666, times.percentile(0.99));
  EXPECT_DOUBLE_EQ(40, times.greatest());
}

TEST(ResponseTimes, PercentilesOfASpreadAreWithinOnePercent) {
  ResponseTimes times;
  for (int i = 1; i <= 10'000; ++i) times.add(i * 0.01);
  EXPECT_NEAR(50, times.median(), 0.5);
  EXPECT_NEAR(99, times.percentile(0.99), 1);
  EXPECT_DOUBLE_EQ(0.01, times.least());
  EXPECT_DOUBLE_EQ(100, times.percentile(1));
}

/// The memory of a soak: a million different times within a factor of ten.
TEST(ResponseTimes, MemoryFollowsTheSpread) {
  ResponseTimes times;
  for (int i = 0; i < 1'000'000; ++i) times.add(1 + i * 9e-6);
  EXPECT_LT(times.bins(), 300u);
}

TEST(ResponseTimes, AddsUp) {
  ResponseTimes some, others, all;
  for (double ms : {1.0, 2.0, 2.001}) some.add(ms), all.add(ms);
  for (double ms : {0.0, 2.002, 7.0}) others.add(ms), all.add(ms);
  some.add(others);
  some.add(ResponseTimes{});
  EXPECT_EQ(6u, some.count());
  for (double part : {0.1, 0.3, 0.5, 0.7, 0.99, 1.0})
    EXPECT_DOUBLE_EQ(all.percentile(part), some.percentile(part)) << part;
  EXPECT_EQ(0, ResponseTimes{}.percentile(0.5));
}

TEST(ResponseTimes, InWords) {
  ResponseTimes times;
  times.add(1);
  EXPECT_EQ("1 reply: min 1.000, median 1.000, p99 1.000, max 1.000 ms",
            to_string(figures_of(times)));
  times.add(3);
  EXPECT_EQ("2 replies: min 1.000, median 1.000, p99 3.000, max 3.000 ms",
            to_string(figures_of(times)));
}

}  // namespace
}  // namespace fieldproof::results
