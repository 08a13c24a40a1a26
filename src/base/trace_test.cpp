#include "src/base/trace.hpp"

#include <gmock/gmock.h>

#include <algorithm>

namespace fieldproof {
namespace {

using Sample = AxisTrace::Sample;

/// Up to 1000 pulses a second, on, and down again, in 3 ms each.
std::vector<Sample> trapezoid() {
  std::vector<Sample> samples;
  Sample at;
  for (int i = 0; i <= 300; ++i) {
    at.speed = std::min({1000.0, i * 20.0, (300 - i) * 20.0});
    at.position += at.speed * 0.003;
    at.time = i * 3ms;
    samples.push_back(at);
  }
  return samples;
}

TEST(Thinned, FewSamplesDrawTheSame) {
  const std::vector<Sample> all = trapezoid(), few = thinned(all, 300);
  EXPECT_THAT(few.size(), testing::AllOf(testing::Ge(4u), testing::Le(30u)));
  for (const Sample& one : all) {
    const auto behind = std::ranges::lower_bound(few, one.time, {}, &Sample::time);
    ASSERT_NE(behind, few.end());
    if (behind->time == one.time) continue;
    const Sample &a = *std::prev(behind), &b = *behind;
    const double share = (one.time - a.time) / 1.0ns / ((b.time - a.time) / 1.0ns);
    EXPECT_NEAR(a.speed + (b.speed - a.speed) * share, one.speed, 1.001);
    EXPECT_NEAR(a.position + (b.position - a.position) * share, one.position, 0.001 * 751);
  }
}

TEST(Thinned, KeepsFirstLastAndExtremes) {
  std::vector<Sample> all = trapezoid();
  all[137].speed = 5000;  // seen in one period alone
  all[201].position = -4000;
  const std::vector<Sample> few = thinned(all, 6);
  EXPECT_EQ(few.size(), 6u) << "no more than asked for";
  EXPECT_EQ(few.front().time, all.front().time);
  EXPECT_EQ(few.back().time, all.back().time);
  for (const auto what : {&Sample::position, &Sample::speed}) {
    EXPECT_EQ(std::ranges::min(few, {}, what).*what, std::ranges::min(all, {}, what).*what);
    EXPECT_EQ(std::ranges::max(few, {}, what).*what, std::ranges::max(all, {}, what).*what);
  }
}

TEST(Thinned, KeepsTheExtremeOfManyAlike) {
  std::vector<Sample> all;
  for (int i = 0; i < 100; ++i) all.push_back({i * 3ms, 0, i % 2 ? 100.0 : -100.0});
  all[77].speed = 100.5;
  all[42].speed = -100.5;
  const std::vector<Sample> few = thinned(all, 6);
  EXPECT_EQ(std::ranges::max(few, {}, &Sample::speed).speed, 100.5);
  EXPECT_EQ(std::ranges::min(few, {}, &Sample::speed).speed, -100.5);
}

TEST(Thinned, NothingMovesInTwoSamples) {
  EXPECT_TRUE(thinned({}, 10).empty());
  EXPECT_EQ(thinned(std::vector<Sample>(500), 10).size(), 2u);
}

}  // namespace
}  // namespace fieldproof
