#include "src/line/silence.hpp"

#include <gtest/gtest.h>

namespace fieldproof::line {
namespace {

using namespace std::chrono_literals;

Burst at(Time start) { return {.bytes = {1, 2}, .start = start, .character_time = 1ms}; }

TEST(Silence, AsLongAsTheLongestKeepsAFrameTogether) {
  Silence silence(5ms);
  silence.heard(at(Time(10ms)));
  EXPECT_EQ(silence.last_end(), Time(12ms));
  EXPECT_FALSE(silence.is_over_before(at(Time(17ms))));
  EXPECT_TRUE(silence.is_over_before(at(Time(17ms + 1ns))));
}

TEST(Silence, IsOverWhenNoCharacterCanBeArriving) {
  Silence silence(5ms);
  silence.heard(at(Time(10ms)));
  EXPECT_EQ(silence.over_at(), Time(18ms + 1ns));
}

}  // namespace
}  // namespace fieldproof::line
