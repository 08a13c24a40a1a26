#include "src/xnet_motion/path.hpp"

#include <gmock/gmock.h>

namespace fieldproof::xnet {
namespace {

using testing::DoubleNear;

// 5000 pulses/s in 50 ms.
constexpr Limits limits{5000, 100'000, 100'000};

TEST(Path, ATrapezoidToItsTarget) {
  const Path path = Path::to(10'000, {}, limits, 0ms);
  EXPECT_EQ(path.ends_at(), 2050ms);  // 50 ms up, 125 pulses; 9750 at 5000; 50 ms down
  EXPECT_THAT(path.at(25ms).position, DoubleNear(31.25, 1e-6));
  EXPECT_THAT(path.at(50ms).position, DoubleNear(125, 1e-6));
  EXPECT_THAT(path.at(50ms).speed, DoubleNear(5000, 1e-6));
  EXPECT_THAT(path.at(1050ms).position, DoubleNear(5125, 1e-6));
  EXPECT_THAT(path.at(2025ms).position, DoubleNear(10'000 - 31.25, 1e-6));
  EXPECT_EQ(path.at(3s).position, 10'000);
  EXPECT_EQ(path.at(3s).speed, 0);
}

TEST(Path, ATriangleWhereTheWayIsShort) {
  const Path path = Path::to(-40, {}, limits, 1s);
  EXPECT_EQ(path.ends_at(), 1040ms);  // 20 ms to 2000 pulses/s and 20 ms back
  EXPECT_THAT(path.at(1020ms).speed, DoubleNear(-2000, 1e-6));
  EXPECT_EQ(path.at(1040ms).position, -40);
}

TEST(Path, ItStopsAndTurnsBackWhereItCannotStopBefore) {
  const Path path = Path::to(400, {600, 5000}, limits, 0ms);
  EXPECT_THAT(path.at(50ms).position, DoubleNear(725, 1e-6));
  EXPECT_THAT(path.at(50ms).speed, DoubleNear(0, 1e-6));
  EXPECT_LT(path.at(80ms).speed, 0);
  EXPECT_EQ(path.at(10s).position, 400);
  EXPECT_EQ(Path::to(650, {600, 5000}, limits, 0ms).at(10s).position, 650);  // too near
}

TEST(Path, ANewSpeedOnTheWay) {
  const Path slower = Path::to(10'000, {1000, 5000}, {1000, 100'000, 100'000}, 0ms);
  EXPECT_THAT(slower.at(40ms).speed, DoubleNear(1000, 1e-6));
  EXPECT_EQ(slower.at(20s).position, 10'000);
  const Path stopped = Path::to(10'000, {1000, 5000}, {0, 100'000, 100'000}, 0ms);
  EXPECT_THAT(stopped.at(1s).position, DoubleNear(1125, 1e-6));
  EXPECT_TRUE(stopped.is_over(50ms));
}

TEST(Path, ItPassesItsTargetAtTheSpeedThatFollows) {
  const Path path = Path::to(1000, {}, limits, 0ms, 5000);
  EXPECT_EQ(path.end().speed, 5000);
  EXPECT_EQ(path.ends_at(), 225ms);  // 50 ms up, 875 pulses at 5000
}

TEST(Path, ASpeedForEver) {
  const Path path = Path::at_speed(-1000, {0, 500}, limits, 0ms);
  EXPECT_FALSE(path.ends());
  EXPECT_THAT(path.at(15ms).speed, DoubleNear(-1000, 1e-6));
  EXPECT_THAT(path.at(1015ms).position - path.at(15ms).position, DoubleNear(-1000, 1e-6));
  EXPECT_TRUE(Path::at_speed(0, {0, 500}, limits, 0ms).is_over(5ms));
  EXPECT_EQ(Path::stop({10, 0}, 1000, 5ms).ends_at(), 5ms);
}

}  // namespace
}  // namespace fieldproof::xnet
