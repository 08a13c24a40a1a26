#include "src/xnet_motion/axis_recorder.hpp"

#include <gmock/gmock.h>

namespace fieldproof::xnet {
namespace {

constexpr Duration refresh = 3ms;

TEST(AxisRecorder, StandingCostsNoSample) {
  AxisRecorder recorder;
  for (int i = 0; i < 100; ++i) {
    recorder.tell(i * refresh);
    recorder.add(i == 99 ? 3 : 0, i == 99 ? 1000 : 0, refresh);
  }
  const auto samples = recorder.samples(1s);
  ASSERT_EQ(samples.size(), 4u);
  EXPECT_EQ(samples[0].time, 0ms);
  EXPECT_EQ(samples[1].time, 98 * refresh) << "it stood until the period before";
  EXPECT_EQ(samples[1].position, 0);
  EXPECT_EQ(samples[2].time, 99 * refresh);
  EXPECT_EQ(samples[3].time, 1s);
}

TEST(AxisRecorder, OneSpeedCostsItsEndsAlone) {
  AxisRecorder recorder;
  for (int i = 0; i <= 4000; ++i) {  // far more than are kept
    recorder.tell(i * refresh);
    recorder.add(std::min(i, 3000) * 3.0, i > 0 && i < 3000 ? 1000 : 0, refresh);
  }
  recorder.tell(4001 * refresh);
  recorder.add(12, 0, refresh);
  std::vector<Time> times;
  for (const AxisTrace::Sample& one : recorder.samples(13s))
    times.push_back(one.time / refresh * 1ns);
  EXPECT_THAT(times, testing::ElementsAre(0ns, 1ns, 2999ns, 3000ns, 4000ns, 4001ns, 4333ns));
}

TEST(AxisRecorder, WhoIsGivenAnotherPositionDidNotMove) {
  AxisRecorder recorder;
  recorder.add(0, 0, refresh);
  recorder.tell(refresh);
  recorder.add(5000, 0, refresh);
  EXPECT_FALSE(recorder.has_moved());
  EXPECT_TRUE(recorder.samples(1s).empty());
}

TEST(AxisRecorder, AnHourStaysSmallAndKeepsExtremes) {
  AxisRecorder recorder;
  double position = 0;
  constexpr int periods = 1'200'000;  // an hour
  for (int i = 0; i <= periods; ++i) {
    const double speed = i == 777'777 ? 9000 : (i / 2000 % 2 ? -1000 : 1000) + i % 7;
    position += speed * 0.003;
    recorder.tell(i * refresh);
    recorder.add(position, speed, refresh);
  }
  const auto samples = recorder.samples(3600s);
  EXPECT_LE(samples.size(), 300u);
  EXPECT_EQ(samples.front().time, 0s);
  EXPECT_EQ(samples.back().time, 3600s);
  EXPECT_NEAR(samples.back().position, position, 0.001);
  EXPECT_EQ(std::ranges::max_element(samples, {}, &AxisTrace::Sample::speed)->speed, 9000);
}

TEST(AxisRecorder, EventsAreManyAtMost) {
  AxisRecorder recorder;
  for (int i = 0; i < 1000; ++i) recorder.note("jog forward");
  ASSERT_EQ(recorder.events().size(), 100u);
  EXPECT_EQ(recorder.events().back().what, "and more that is not kept");
}

}  // namespace
}  // namespace fieldproof::xnet
