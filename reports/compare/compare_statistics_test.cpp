#include "reports/compare/compare_statistics.hpp"

#include <gmock/gmock.h>

#include <random>

namespace fieldproof::compare {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;

std::vector<double> sample(std::size_t count, double from, double step) {
  std::vector<double> values;
  for (std::size_t i = 0; i < count; ++i) values.push_back(from + step * static_cast<double>(i));
  return values;
}

/// The figures are those of published tables and of counting by hand: 2 of the C(n1+n2, n1) ways
/// are as extreme.
TEST(MannWhitney, IsExactForFewSamples) {
  const RankTest apart = mann_whitney({1, 2, 3, 4}, {5, 6, 7, 8});
  EXPECT_TRUE(apart.exact);
  EXPECT_DOUBLE_EQ(apart.p, 2.0 / 70);
  EXPECT_DOUBLE_EQ(apart.shift, 4);
  EXPECT_DOUBLE_EQ(mann_whitney({5, 6, 7, 8}, {1, 2, 3, 4}).p, 2.0 / 70);
  EXPECT_DOUBLE_EQ(mann_whitney({5, 6, 7, 8}, {1, 2, 3, 4}).shift, -4);
  EXPECT_DOUBLE_EQ(mann_whitney({1, 2, 4}, {3, 5, 6, 7}).p,
                   4.0 / 35);  // U = 1: 2 ways of 35 on each side
  EXPECT_DOUBLE_EQ(mann_whitney({1}, {2}).p, 1);
  EXPECT_DOUBLE_EQ(mann_whitney({}, {2}).p, 1);
}

TEST(MannWhitney, TakesTiesIntoAccount) {
  EXPECT_DOUBLE_EQ(mann_whitney({3, 3, 3, 3}, {3, 3, 3, 3}).p, 1);
  // Simulated time: each run repeats one value exactly.
  EXPECT_DOUBLE_EQ(mann_whitney({3, 3, 3, 3}, {4, 4, 4, 4}).p, 2.0 / 70);
  // Of the 6 ways to choose 2 of {1, 2, 2, 3}: middle ranks 1, 2.5, 2.5, 4; sums 3.5, 3.5, 5,
  // 5, 6.5, 6.5.
  EXPECT_DOUBLE_EQ(mann_whitney({1, 2}, {2, 3}).p, 4.0 / 6);
}

TEST(MannWhitney, ApproximatesWhereThereAreMany) {
  const auto before = sample(30, 10, 0.1), same = sample(30, 10.05, 0.1),
             later = sample(30, 12, 0.1);
  EXPECT_FALSE(mann_whitney(before, same).exact);
  EXPECT_GT(mann_whitney(before, same).p, 0.5);
  EXPECT_LT(mann_whitney(before, later).p, 1e-5);
  EXPECT_THAT(mann_whitney(before, later).shift, DoubleNear(2, 1e-9));
  EXPECT_DOUBLE_EQ(mann_whitney(std::vector<double>(50, 1), std::vector<double>(50, 1)).p, 1);
}

/// Counted out by another program: of 15 and 30 values, U = 345 is exact at p = 0.00322. Farther
/// out the approximation is too large, that is, on the safe side: 0.000224 at U = 372.
TEST(MannWhitney, ApproximationAgreesWithTheExactDistribution) {
  const auto before = sample(15, 0.5, 1);
  const RankTest near = mann_whitney(before, sample(30, 1, 1));
  EXPECT_FALSE(near.exact);
  EXPECT_NEAR(near.p, 0.003224942936018481, 0.001);
  const RankTest far = mann_whitney(before, sample(30, 3, 1));
  EXPECT_GT(far.p, 0.0002244467011313786);
  EXPECT_LT(far.p, 2 * 0.0002244467011313786);
}

/// Where nothing changed, an alarm at 5 % must be as rare as promised: counted over many draws.
TEST(MannWhitney, FalseAlarmsAreAsRareAsPromised) {
  std::mt19937 random(7);
  std::lognormal_distribution<double> times(1, 0.5);
  int alarms = 0;
  constexpr int draws = 2000;
  for (int i = 0; i < draws; ++i) {
    std::vector<double> before, after;
    for (int k = 0; k < 8; ++k) before.push_back(times(random)), after.push_back(times(random));
    alarms += mann_whitney(before, after).p <= 0.05;
  }
  EXPECT_LT(alarms, draws * 0.065);
  EXPECT_GT(alarms, draws * 0.03);
}

TEST(MannWhitney, HugeSamplesAreBearable) {
  const auto many = sample(200'000, 0, 0.001);
  EXPECT_DOUBLE_EQ(mann_whitney(many, many).p, 1);
  EXPECT_DOUBLE_EQ(mann_whitney(many, many).shift, 0);
}

TEST(Holm, RaisesEachByItsRankAndKeepsTheOrder) {
  EXPECT_THAT(
      holm({0.04, 0.01, 0.03}),
      ElementsAre(DoubleNear(0.06, 1e-12), DoubleNear(0.03, 1e-12), DoubleNear(0.06, 1e-12)));
  EXPECT_THAT(holm({0.9, 0.8}), ElementsAre(1.0, 1.0));
  EXPECT_TRUE(holm({}).empty());
}

TEST(SamplesNeeded, GrowsWithTheNumberOfTests) {
  EXPECT_EQ(samples_needed(1, 0.05), 4u);      // 2/C(8,4) = 0.029, 2/C(6,3) = 0.1
  EXPECT_EQ(samples_needed(3000, 0.05), 10u);  // 2/C(20,10) = 1.08e-5, 0.05/3000 = 1.67e-5
  EXPECT_EQ(samples_needed(0, 0.05), 4u);
}

TEST(Median, OfEvenOddAndNone) {
  EXPECT_DOUBLE_EQ(median({3, 1, 2}), 2);
  EXPECT_DOUBLE_EQ(median({4, 1, 2, 3}), 2.5);
  EXPECT_DOUBLE_EQ(median({}), 0);
}

}  // namespace
}  // namespace fieldproof::compare
