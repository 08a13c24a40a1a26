#include "reports/history/change_point.hpp"

#include <gmock/gmock.h>

#include <random>

namespace fieldproof::history {
namespace {

using testing::DoubleNear;
using testing::Each;
using testing::Eq;

constexpr Relevance any_shift{0.5, 0.05};

std::optional<ChangePoint> change_of(const std::vector<double>& series) {
  std::size_t tested = 0;
  return change_points({series}, any_shift, tested).at(0);
}

std::vector<double> noise(std::size_t count, double middle, unsigned seed) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> spread(middle, 0.2);
  std::vector<double> series(count);
  for (double& one : series) one = spread(generator);
  return series;
}

TEST(ChangePoint, IsBetweenTheLastRunBeforeAndTheFirstAfter) {
  std::vector<double> series = noise(9, 4, 1), after = noise(6, 6, 2);
  series.insert(series.end(), after.begin(), after.end());
  const auto change = change_of(series);
  ASSERT_TRUE(change);
  EXPECT_EQ(change->at, 9u);
  EXPECT_THAT(change->before, DoubleNear(4, 0.3));
  EXPECT_THAT(change->shift, DoubleNear(2, 0.3));
  // 2 of the 5005 ways to deal 15 ranks out part them so, at one of 8 places.
  EXPECT_NEAR(change->p, 2.0 / 5005 * 8, 1e-9);
  EXPECT_EQ(change->corrected_p, change->p) << "one series";
}

TEST(ChangePoint, GoesEitherWay) {
  std::vector<double> series = noise(8, 6, 1), after = noise(8, 4, 2);
  series.insert(series.end(), after.begin(), after.end());
  ASSERT_TRUE(change_of(series));
  EXPECT_EQ(change_of(series)->at, 8u);
  EXPECT_LT(change_of(series)->shift, -1.5);
}

TEST(ChangePoint, NoneInNoiseNorWhereItDoesNotMatter) {
  for (unsigned seed = 1; seed <= 20; ++seed) EXPECT_FALSE(change_of(noise(30, 4, seed))) << seed;
  std::vector<double> small(10, 4.0);
  small.resize(20, 4.4);
  EXPECT_FALSE(change_of(small)) << "0.4 ms is below what counts";
  EXPECT_FALSE(change_of({4, 4, 4, 9, 9, 9})) << "too few runs";
  EXPECT_FALSE(change_of(std::vector<double>(40, 4.0)));
}

TEST(ChangePoint, SeveralSeriesAreCorrectedTogether) {
  std::vector<double> step(6, 4.0);
  step.resize(12, 8.0);
  EXPECT_TRUE(change_of(step));
  std::vector<std::vector<double>> many{step};
  for (unsigned seed = 1; seed <= 30; ++seed) many.push_back(noise(12, 4, seed));
  many.emplace_back(12, 4.0);
  std::size_t tested = 0;
  EXPECT_THAT(change_points(many, any_shift, tested), Each(Eq(std::nullopt)))
      << "a clean step of twelve runs is not enough among thirty";
  EXPECT_EQ(tested, 31u) << "the constant one says nothing";
}

TEST(ChangePoint, LongSeriesStayFast) {
  std::vector<double> series = noise(6000, 4, 1), after = noise(4000, 6, 2);
  series.insert(series.end(), after.begin(), after.end());
  ASSERT_TRUE(change_of(series));
  EXPECT_EQ(change_of(series)->at, 6000u);
}

}  // namespace
}  // namespace fieldproof::history
